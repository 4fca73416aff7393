#include "tools/endurance/rounds.hpp"

#include <algorithm>
#include <set>

namespace gvom::endurance {

namespace {

constexpr std::int64_t kSettled_ns = 3'000'000'000;      // Health comes once a second
constexpr std::int64_t kForgotten_ns = 120'000'000'000;  // longer than any round may be
constexpr std::size_t kMostKeys = 200'000;
constexpr std::size_t kMostDefects = 20;

}  // namespace

void RoundBook::begin(std::uint64_t epoch) {
  open_.push_back({epoch, 0, {}});
}

void RoundBook::end(std::uint64_t epoch, std::int64_t mono_ns) {
  for (Round& round : open_)
    if (round.epoch == epoch) round.end_ns = mono_ns;
}

void RoundBook::add(const LayersNote& note) {
  for (Round& round : open_)
    if (round.epoch == note.epoch) round.notes.push_back(note);
}

void RoundBook::disturb(std::int64_t from_ns, std::int64_t to_ns, const std::string& what) {
  while (!disturbances_.empty() && disturbances_.front().to_ns < to_ns - kForgotten_ns)
    disturbances_.pop_front();
  if (!disturbances_.empty() && disturbances_.back().from_ns == from_ns && disturbances_.back().what == what)
    disturbances_.back().to_ns = to_ns;
  else
    disturbances_.push_back({from_ns, to_ns, what});
}

void RoundBook::settle(std::int64_t now_ns) {
  while (!open_.empty()) {
    const Round* const next = open_.size() > 1 ? &open_[1] : nullptr;
    const Round& round = open_.front();
    const auto over_ns = next != nullptr ? static_cast<std::int64_t>(next->epoch) : round.end_ns;
    if (over_ns == 0 || now_ns < over_ns + kSettled_ns) return;
    judge(round, next);
    before_ = round.notes.empty() ? LayersNote{} : round.notes.back();
    open_.pop_front();
  }
}

void RoundBook::judge(const Round& round, const Round* next) {
  ++rounds_;
  const auto next_ns = next != nullptr ? static_cast<std::int64_t>(next->epoch) : round.end_ns;
  if (is_disturbed(round, next_ns)) return;
  ++clean_;
  if (next != nullptr) check_maps(round, *next);
  compare(round);
}

bool RoundBook::is_disturbed(const Round& round, std::int64_t next_ns) {
  std::set<std::string> causes;
  if (round.end_ns == 0) causes.insert("cut short by a new round");
  for (const Disturbance& disturbance : disturbances_)
    if (disturbance.from_ns < next_ns && disturbance.to_ns > static_cast<std::int64_t>(round.epoch))
      causes.insert(disturbance.what);
  for (const std::string& cause : causes) ++causes_[cause];
  return !causes.empty();
}

/// Only where we heard all layers from the last of the round before to the first of the next one.
void RoundBook::check_maps(const Round& round, const Round& next) {
  if (round.notes.empty() || next.notes.empty() || before_.sequence == 0) return;
  const LayersNote& last = round.notes.back();
  const bool all_heard = last.sequence - before_.sequence == round.notes.size() &&
                         next.notes.front().sequence == last.sequence + 1;
  if (!all_heard) return;
  for (std::size_t i = 0; i < sweeps_.size(); ++i) {
    const std::uint64_t maps = last.maps[i] - before_.maps[i];
    if (maps != sweeps_[i])
      add_defect("lidar " + std::to_string(i) + " made " + std::to_string(maps) + " maps of " +
                 std::to_string(sweeps_[i]) + " sweeps in a round in which nothing was counted as lost");
  }
}

void RoundBook::compare(const Round& round) {
  for (const LayersNote& note : round.notes) {
    const auto known = known_.find(note.key);
    if (known == known_.end()) {
      if (known_.size() < kMostKeys) known_.emplace(note.key, note.checksum);
      continue;
    }
    ++compared_;
    if (known->second == note.checksum) continue;
    ++wrong_;
    add_defect("round " + std::to_string(rounds_) + ", layers " + std::to_string(note.sequence) +
               ": other bytes than in a round before, made of the same maps");
  }
}

void RoundBook::add_defect(std::string what) {
  ++defect_count_;
  if (defects_.size() < kMostDefects) defects_.push_back(std::move(what));
}

}  // namespace gvom::endurance
