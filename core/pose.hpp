// Rigid transforms between REP-105 frames.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace gvom {

/// `T_odom_base` and the like: a unit quaternion and a translation in metres.
struct Pose {
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// A pose at a time of the sensors' clock.
struct StampedPose {
  std::int64_t stamp_ns = 0;
  Pose T_odom_base;
};

}  // namespace gvom
