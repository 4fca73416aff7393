// One map as it is judged: its layers, and where the vehicle really was.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/format/layers.hpp"

namespace gvom::evaluation {

inline constexpr double kNear_m = 15.0;
inline constexpr double kFar_m = 30.0;
inline constexpr std::uint8_t kLethalFlags = kHard | kNegative | kSteep;
inline constexpr std::uint8_t kObstacleFlags = kHard | kSoft;

/// Layers are borrowed: size * size values, indexed [y][x]. Everything else is true, not from the odometry.
struct Frame {
  double time_s = 0.0;                                 ///< After the start of the drive.
  double driven_m = 0.0;                               ///< Along the path.
  Eigen::Vector2d base_m = Eigen::Vector2d::Zero();    ///< base_link in odom.
  Eigen::Vector2d forward = Eigen::Vector2d::UnitX();  ///< A unit vector in odom.
  Eigen::Vector3d sensor_m = Eigen::Vector3d::Zero();  ///< The lidar in odom.
  std::array<std::int64_t, 2> origin{};                ///< World voxel (R1) of column (0, 0).
  int size = 0;
  const float* height = nullptr;
  const std::uint8_t* flags = nullptr;
  const std::uint8_t* visibility = nullptr;

  /// Metres from the vehicle to a point ahead of it; infinite for what is beside or behind.
  [[nodiscard]] double ahead_m(const Eigen::Vector2d& point_m) const {
    const Eigen::Vector2d way = point_m - base_m;
    return way.dot(forward) > 0.0 ? way.norm() : HUGE_VAL;
  }
};

/// Ground that a ray has hit, now or as it is remembered: the only ground whose height is judged, and that
/// counts as covered.
inline bool ground_is_known(std::uint8_t visibility, float height) {
  return visibility == static_cast<std::uint8_t>(Visibility::ground_seen) ||
         (is_remembered(visibility) && std::isfinite(height));
}
inline bool is_observed(std::uint8_t visibility) {
  return visibility != static_cast<std::uint8_t>(Visibility::unobserved);
}

}  // namespace gvom::evaluation
