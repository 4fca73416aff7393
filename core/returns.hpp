// What becomes of one return (R2, R3), for host and device.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/config.hpp"
#include "core/grid.hpp"
#include "core/pose.hpp"
#include "core/ray.hpp"
#include "core/sweep.hpp"

namespace gvom {

/// What the filter (R2) did with a sweep's returns.
struct FilterCounts {
  std::uint64_t used = 0;
  std::uint64_t not_finite = 0;
  std::uint64_t too_near = 0;
  std::uint64_t too_far = 0;
  std::uint64_t body = 0;
};

/// What the filter (R2) does with a return. The values index counters.
enum class Verdict : std::uint32_t { used, not_finite, too_near, too_far, body };
inline constexpr int kVerdicts = 5;

/// A rigid transform as plain numbers, so that every machine multiplies and adds in the same order.
struct RigidTransform {
  double r[3][3];
  double t[3];

  GVOM_HD double coordinate(int i, double x, double y, double z) const {
    return ((r[i][0] * x + r[i][1] * y) + r[i][2] * z) + t[i];
  }
};

inline RigidTransform plain(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation_m) {
  RigidTransform plain;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) plain.r[i][j] = rotation(i, j);
    plain.t[i] = translation_m[i];
  }
  return plain;
}

/// `T_odom_base * T_base_sensor` (R3).
inline RigidTransform sensor_in_odom(const Pose& T_odom_base, const Eigen::Isometry3d& T_base_sensor) {
  const Eigen::Matrix3d R = T_odom_base.rotation.toRotationMatrix();
  return plain(R * T_base_sensor.linear(), R * T_base_sensor.translation() + T_odom_base.translation_m);
}

/// The filter of one lidar as plain numbers (R2).
struct ReturnFilter {
  double min_range_m, max_range_m;
  bool has_body;
  double body_min_m[3], body_max_m[3];  ///< In base_link.
  RigidTransform T_base_sensor;

  ReturnFilter(const LidarGeometry& lidar, const VehicleGeometry& vehicle)
      : min_range_m(lidar.min_range_m),
        max_range_m(lidar.max_range_m),
        has_body(vehicle.body.has_value()),
        T_base_sensor(plain(lidar.T_base_sensor.linear(), lidar.T_base_sensor.translation())) {
    for (int a = 0; a < 3; ++a) {
      body_min_m[a] = has_body ? vehicle.body->min_m[a] : 0;
      body_max_m[a] = has_body ? vehicle.body->max_m[a] : 0;
    }
  }

  GVOM_HD Verdict judge(const Return& r) const {
    const double squares = (r.x_m * r.x_m + r.y_m * r.y_m) + r.z_m * r.z_m;
    if (!(is_finite(r.x_m) && is_finite(r.y_m) && is_finite(r.z_m))) return Verdict::not_finite;
    const double range_m = std::sqrt(squares);
    if (range_m < min_range_m) return Verdict::too_near;
    if (range_m > max_range_m) return Verdict::too_far;
    return in_body(r) ? Verdict::body : Verdict::used;
  }

 private:
  GVOM_HD static bool is_finite(double value) { return value - value == 0; }

  GVOM_HD bool in_body(const Return& r) const {
    if (!has_body) return false;
    for (int a = 0; a < 3; ++a) {
      const double p_base_m = T_base_sensor.coordinate(a, r.x_m, r.y_m, r.z_m);
      if (!(p_base_m >= body_min_m[a] && p_base_m <= body_max_m[a])) return false;
    }
    return true;
  }
};

/// A coordinate in odom as a fixed-point number of voxels from the grid's origin (core/ray.hpp).
GVOM_HD inline std::int64_t fixed_in_grid(double coordinate_m, double resolution_m, std::int32_t origin) {
  return to_fixed(voxel_coordinate(coordinate_m, resolution_m), origin);
}

/// The height that a return's voxel keeps, metres in odom (R4): -0 and 0 are one height.
GVOM_HD inline float height_of_return(double z_m) {
  return static_cast<float>(z_m) + 0.0f;
}

}  // namespace gvom
