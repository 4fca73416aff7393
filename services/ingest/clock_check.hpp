// Whether a lidar's clock is the odometry's.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "core/time_span.hpp"

namespace gvom::ingest {

/// Live: how far a lidar's clock is from the odometry's, by when things came. A message only ever comes later
/// than its stamp, so the least delay of the last one to two seconds' odometry is that of its clock: one that
/// was held up, or that we were late to take, says nothing. Times of arrival are CLOCK_MONOTONIC.
class ClockCheck {
 public:
  void take_odometry(std::int64_t stamp_ns, std::int64_t came_ns);
  /// The odometry's clock is another one now.
  void forget() { *this = {}; }

  /// Of a sweep whose newest time is `time_ns`: how far it is ahead of what the odometry's clock said when it
  /// came; nothing before the first odometry.
  [[nodiscard]] std::optional<std::int64_t> ahead_ns(std::int64_t time_ns, std::int64_t received_ns) const;

 private:
  static constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();

  std::int64_t begin_ns_ = 0;            // of the second that runs
  std::int64_t least_delay_ns_ = kNone;  // came - stamp, in this second
  std::int64_t before_ns_ = kNone;       // ... and in the one before
};

/// What an offset between two clocks looks like: "that is TAI - UTC", "the lidar's counts from its boot";
/// empty if nothing that is known.
/// @param ahead_ns of the lidar's before the odometry's, give or take half a second
const char* guess_clock(std::int64_t ahead_ns, std::int64_t lidar_ns, std::int64_t odometry_ns);

/// The same for recordings whose times do not meet, from what they span. Says only what is the one way in
/// which the sweeps would lie within the odometry.
const char* guess_clock(const TimeSpan& sweeps, const TimeSpan& odometry);

/// Of recordings whose times meet in part: the known offset by which both would begin and end together.
const char* guess_shift(const TimeSpan& sweeps, const TimeSpan& odometry);

}  // namespace gvom::ingest
