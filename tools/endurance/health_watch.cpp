#include "tools/endurance/health_watch.hpp"

#include <algorithm>

#include "ipc/text.hpp"
#include "tools/common/health_view.hpp"

namespace gvom::endurance {

namespace {

constexpr std::int64_t kSilence_ns = 3'000'000'000;

/// Returns that the filter leaves out are none: each round has the same.
bool is_loss(const std::string& counter) {
  if (counter.compare(0, 12, "drop_return_") == 0) return counter == "drop_return_overflow";
  for (const char* const other : {"sweep_incomplete", "column_missing", "column_invalid",
                                  "packet_out_of_order", "odometry_gaps", "odometry_jumps"})
    if (counter == other) return true;
  return tools::is_drop(counter);
}

bool is_ok(const ipc::Health& health) {
  return health.state == static_cast<std::uint32_t>(ipc::HealthState::ok);
}

std::uint64_t value_of(const tools::Counters& counters, const std::string& name) {
  for (const auto& [counter, value] : counters)
    if (counter == name) return value;
  return 0;
}

}  // namespace

void HealthWatch::take(const ipc::Health& health, RoundBook& rounds) {
  const std::string process(ipc::text_of(health.process));
  if (std::find(expected_.begin(), expected_.end(), process) == expected_.end()) return;
  const auto known = newest_.find(process);
  if (known != newest_.end()) compare(process, known->second, health, rounds);
  newest_[process] = health;
}

void HealthWatch::compare(const std::string& process, const ipc::Health& before, const ipc::Health& health,
                          RoundBook& rounds) {
  const auto disturb = [&](const std::string& what) { rounds.disturb(before.mono_ns, health.mono_ns, what); };
  const bool same_life = health.pid == before.pid;
  if (!same_life) {
    ++restarts_[process];
    disturb(process + " began anew");
  }
  const auto counted = tools::counters_of(before);
  for (const auto& [name, value] : tools::counters_of(health)) {
    const std::uint64_t old = same_life ? value_of(counted, name) : 0;
    if (!is_loss(name) || value <= old) continue;
    losses_[process + " " + name] += value - old;
    disturb(process + " " + name);
  }
  const bool not_yet = health.state == static_cast<std::uint32_t>(ipc::HealthState::starting);
  if (is_ok(health) || (not_yet && restarts_.count(process) == 0)) return;
  const std::string what = process + " " + tools::to_string(static_cast<ipc::HealthState>(health.state));
  Complaint& complaint = complaints_[what];
  ++complaint.messages;
  complaint.newest = ipc::text_of(health.reason);
}

void HealthWatch::look_for_silence(std::int64_t now_ns, RoundBook& rounds) const {
  for (const auto& [process, health] : newest_)
    if (now_ns - health.mono_ns > kSilence_ns)
      rounds.disturb(health.mono_ns, now_ns, process + " says nothing");
}

const ipc::Health* HealthWatch::newest(const std::string& process) const {
  const auto known = newest_.find(process);
  return known == newest_.end() ? nullptr : &known->second;
}

bool HealthWatch::all_heard() const {
  return newest_.size() == expected_.size();
}

bool HealthWatch::all_ok(std::int64_t since_ns) const {
  return all_heard() && std::all_of(newest_.begin(), newest_.end(), [since_ns](const auto& known) {
           return known.second.mono_ns > since_ns && is_ok(known.second);
         });
}

}  // namespace gvom::endurance
