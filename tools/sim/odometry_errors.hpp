// How far odometry is off, pose by pose.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/pose.hpp"
#include "tools/sim/noise.hpp"

namespace gvom::sim {

/// Odometry that is off by `noise`: errors with a memory of one second, so that they are smooth within a
/// sweep as those of wheels and inertial sensors are. Standard deviations in metres (each axis) and
/// radians (about each axis).
struct OdometryNoise {
  double position_m = 0.0;
  double rotation_rad = 0.0;
};

/// Draws the errors of one drive, in order of time.
class OdometryErrors {
 public:
  OdometryErrors(const OdometryNoise& noise, int rate_hz, std::uint64_t seed);

  /// What odometry says of the next pose, `1 / rate_hz` after the last.
  Pose disturb(const Pose& T_odom_base);

 private:
  Eigen::Vector3d draw();

  OdometryNoise noise_;
  double kept_;   // of an error, from one pose to the next
  double fresh_;  // of what is drawn
  Random random_;
  Eigen::Vector3d shift_;  // in standard deviations
  Eigen::Vector3d turn_;
};

}  // namespace gvom::sim
