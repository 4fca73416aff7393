// Why sweeps were never placed by odometry, and how many.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/time_span.hpp"

namespace gvom::ingest {

/// Why a sweep can never be placed.
enum class SweepLoss {
  before_odometry,  ///< It began before the oldest pose.
  after_odometry,   ///< A recording's odometry ended before it.
  gap,              ///< It reaches into a gap.
  jump,             ///< It reaches across a jump.
  timeout,          ///< A sensor's: the odometry that it needs did not come in time.
  clock,            ///< A sensor's: its clock is not the odometry's.
  count
};

/// Of one lidar, beside those that were placed.
class SweepLosses {
 public:
  struct Of {
    std::uint64_t count = 0;
    TimeSpan stamps;  ///< From the first of these sweeps to the last; nothing if there is none.
  };

  void count(SweepLoss why, std::int64_t stamp_ns) { count(of_[static_cast<std::size_t>(why)], stamp_ns); }
  void count_placed(std::int64_t stamp_ns) { count(placed_, stamp_ns); }

  [[nodiscard]] const Of& of(SweepLoss why) const { return of_[static_cast<std::size_t>(why)]; }
  [[nodiscard]] const Of& placed() const { return placed_; }
  [[nodiscard]] std::uint64_t all() const {
    std::uint64_t all = 0;
    for (const Of& of : of_) all += of.count;
    return all;
  }

 private:
  static void count(Of& of, std::int64_t stamp_ns) {
    if (of.count++ == 0) of.stamps = {stamp_ns, stamp_ns};
    of.stamps.first_ns = std::min(of.stamps.first_ns, stamp_ns);
    of.stamps.last_ns = std::max(of.stamps.last_ns, stamp_ns);
  }

  std::array<Of, static_cast<std::size_t>(SweepLoss::count)> of_{};
  Of placed_;
};

}  // namespace gvom::ingest
