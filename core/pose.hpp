// Rigid transforms between REP-105 frames.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "core/format/grid.hpp"

namespace gvom {

/// `T_odom_base` and the like: a unit quaternion and a translation in metres.
struct Pose {
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

inline Pose pose_of(const PoseRecord& record) {
  const auto& p = record.position_m;
  const auto& q = record.orientation_xyzw;
  return {{p[0], p[1], p[2]}, {q[3], q[0], q[1], q[2]}};
}

inline PoseRecord record_of(const Pose& pose) {
  const auto& p = pose.translation_m;
  const auto& q = pose.rotation;
  return {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

/// A pose at a time of the sensors' clock.
struct StampedPose {
  std::int64_t stamp_ns = 0;
  Pose T_odom_base;
};

}  // namespace gvom
