#include "tools/endurance/pauses.hpp"

#include <algorithm>

#include "ipc/text.hpp"

namespace gvom::endurance {

namespace {

constexpr std::int64_t kUnderWay_ns = 120'000'000;  // until the last sweep is in the layers

}  // namespace

void Pauses::begin(const RoundNote& through) {
  pause_ = through;
  told_.clear();
}

void Pauses::end(std::int64_t mono_ns) {
  for (const auto& [process, health] : told_)
    if (health.mono_ns < mono_ns) look(process, health);
  told_.clear();
  pause_.reset();
}

void Pauses::take(const ipc::Health& health) {
  if (!pause_ || health.mono_ns < pause_->mono_ns + kUnderWay_ns) return;
  const std::string process(ipc::text_of(health.process));
  // A long pause, such as the last one, has several: each is a look.
  const auto told = told_.find(process);
  if (told != told_.end()) look(process, told->second);
  told_[process] = health;
}

void Pauses::take(const LayersNote& note) {
  if (fusion_life_ == 0 || note.sequence <= newest_.sequence) ++fusion_life_;
  newest_ = note;
}

void Pauses::look(const std::string& process, const ipc::Health& health) {
  const auto first = first_pids_.find(process);
  Pause pause;
  pause.first_life = first != first_pids_.end() && first->second == health.pid;
  pause.fusion_life = fusion_life_;
  pause.layers = newest_.sequence;
  const std::string life = process + " (" + std::to_string(health.pid) + ")";
  const auto counters = tools::counters_of(health);
  if (process == "gvom-fusion") return ledger_.look_at_fusion(life, counters, pause);
  const auto lidar = std::find(lidars_.begin(), lidars_.end(), tools::lidar_of(process));
  if (lidar == lidars_.end()) return;
  const auto index = static_cast<std::size_t>(lidar - lidars_.begin());
  pause.packets = pause_->sent[index];
  pause.maps = newest_.maps[index];
  ledger_.look_at_ingest(life, counters, pause);
}

}  // namespace gvom::endurance
