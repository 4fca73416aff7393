#include "services/ingest/ouster_turns.hpp"

#include <cstdio>

namespace gvom::ingest {
namespace {

constexpr double kLonger =
    1.5;                      // than a turn of the metadata's mode; the next slower one takes twice as long
constexpr double kSteps = 6;  // farther off is a step of the sensor's clock

double since_ns(std::int64_t before_ns, const OusterColumn& column) {
  return static_cast<double>(column.timestamp_ns) - static_cast<double>(before_ns);
}

}  // namespace

void OusterTurns::begin(const OusterColumn& first, const Frame* before, bool is_next) {
  if (is_next) note_long_turn(turns_later(first));
  if (before != nullptr && turns_sooner(first, *before)) {
    short_turn_ = before->highest + 1;
    warn("turns end with column " + std::to_string(before->highest) + ", the metadata has " +
         std::to_string(columns_));
  }
  begun_ = first;
}

/// The frame that follows begins where, by the columns' own times, the one before had a good part of its turn
/// to go: a turn has fewer columns than the metadata says, at the same distance in time.
bool OusterTurns::turns_sooner(const OusterColumn& first, const Frame& before) const {
  if (turns_per_s_ <= 0 || !first.valid || before.highest < 0) return false;
  const double to_go = columns_ - before.highest + first.measurement_id;
  const double gone = since_ns(before.newest_ns, first) * 1e-9 * turns_per_s_ * columns_;
  return to_go > columns_ / 4.0 && gone > 0 && gone < to_go / 2;
}

/// The next frame begins so much later that the one before had columns beyond the metadata's: what is within
/// is a part of a turn.
bool OusterTurns::turns_later(const OusterColumn& first) const {
  if (turns_per_s_ <= 0 || !first.valid || !begun_.valid) return false;
  const double turns = 1 + static_cast<double>(first.measurement_id - begun_.measurement_id) / columns_;
  const double gone = since_ns(static_cast<std::int64_t>(begun_.timestamp_ns), first) * 1e-9 * turns_per_s_;
  return gone > kLonger * turns && gone < kSteps * turns;
}

/// Until a turn takes as long as it should.
void OusterTurns::note_long_turn(bool is_long) {
  long_turn_ = is_long;
  if (!is_long) return;
  char what[96];
  std::snprintf(what, sizeof what, "a turn takes longer than in the metadata's mode, 1/%.0f s", turns_per_s_);
  warn(what);
}

void OusterTurns::warn(const std::string& what) {
  if (warned_) return;
  warned_ = true;
  warnings_.push_back(what + ": fetch the metadata of the mode that the sensor is in; nothing is used");
}

/// A short turn is none any more where one goes on beyond it.
bool OusterTurns::fit(int highest) {
  if (highest >= short_turn_) short_turn_ = 0;
  return short_turn_ == 0 && !long_turn_;
}

}  // namespace gvom::ingest
