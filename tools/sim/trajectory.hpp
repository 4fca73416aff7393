// How the vehicle drives: along the trail at constant speed, pitching and rolling with the terrain.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pose.hpp"
#include "tools/sim/landscape.hpp"

namespace gvom::sim {

class Trajectory {
 public:
  /// `length_m` of trail from x = 0; `base_height_m` is that of base_link above the ground (R9).
  Trajectory(const Landscape& landscape, double speed_mps, double length_m, double base_height_m);

  /// T_odom_base `time_s` after the start of the drive; a little before and after the drive too.
  [[nodiscard]] Pose at(double time_s) const;

 private:
  [[nodiscard]] double x_after(double driven_m) const;

  const Landscape& landscape_;
  double speed_mps_;
  double base_height_m_;
  std::vector<double> x_m_;  // of the trail's points at equal steps along it
};

/// Odometry that is off by `noise`: errors with a memory of one second, so that they are smooth within a
/// sweep as those of wheels and inertial sensors are. Standard deviations in metres (each axis) and
/// radians (about each axis).
struct OdometryNoise {
  double position_m = 0.0;
  double rotation_rad = 0.0;
};

/// Poses at `rate_hz`, from 50 ms before `begin_ns` to 50 ms after `end_ns`. `start_ns` is the start of
/// the drive.
struct OdometrySpan {
  std::int64_t start_ns;
  std::int64_t begin_ns;
  std::int64_t end_ns;
  int rate_hz;
};
std::vector<StampedPose> make_odometry(const Trajectory& trajectory, const OdometrySpan& span,
                                       const OdometryNoise& noise, std::uint64_t seed);

}  // namespace gvom::sim
