// One turn of a lidar, as a decoder leaves it and the voxelizer takes it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/time_span.hpp"

namespace gvom {

/// A return in the sensor's frame, metres, with the index of its time in `Sweep::times_ns`.
struct Return {
  double x_m;
  double y_m;
  double z_m;
  std::uint32_t time_index;
};

/// Returns that share a time (a column, a firing) share an entry of `times_ns`, so poses are
/// interpolated once for each (R3). Vectors keep their capacity from sweep to sweep.
struct Sweep {
  std::vector<Return> returns;
  std::vector<std::int64_t> times_ns;
  std::int64_t stamp_ns = 0;  ///< The time of the last return (R1).
  /// CLOCK_MONOTONIC when the last packet of the sweep was read; 0 where a replay has no such moment.
  std::int64_t received_ns = 0;
  std::int64_t suspended_ns = 0;       ///< How long the machine had been suspended until then.
  bool complete = true;                ///< False if packets or columns of it are missing.
  double columns_seen_fraction = 1.0;  ///< Of its columns, 0 .. 1; 1 if it is complete.

  void clear() {
    returns.clear();
    times_ns.clear();
    stamp_ns = 0;
    received_ns = 0;
    suspended_ns = 0;
    complete = true;
    columns_seen_fraction = 1.0;
  }
};

/// The times for which the sweep needs a pose: its stamp and those of its returns (R3). A column without a
/// return needs none, so the odometry may begin after it, or end before it.
inline TimeSpan span_of(const Sweep& sweep) {
  TimeSpan span{sweep.stamp_ns, sweep.stamp_ns};
  for (const Return& r : sweep.returns) {
    const std::int64_t time_ns = sweep.times_ns[r.time_index];
    span.first_ns = std::min(span.first_ns, time_ns);
    span.last_ns = std::max(span.last_ns, time_ns);
  }
  return span;
}

}  // namespace gvom
