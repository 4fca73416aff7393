// Arcs: what a vehicle drives while its curvature stays.
#pragma once

#include <cmath>

#include "services/planner/map_view.hpp"

namespace gvom::planner {

/// -pi .. pi.
inline double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2 * 3.14159265358979323846);
}

/// @param length_m along the arc; negative: backwards
inline Pose2 moved(const Pose2& from, double length_m, double curvature_per_m) {
  const double half_rad = curvature_per_m * length_m / 2;
  const double chord_m = std::abs(half_rad) < 1e-6 ? length_m : length_m * std::sin(half_rad) / half_rad;
  const double yaw_rad = from.yaw_rad + half_rad;
  return {from.x_m + chord_m * std::cos(yaw_rad), from.y_m + chord_m * std::sin(yaw_rad),
          from.yaw_rad + 2 * half_rad};
}

/// Of the arc that begins along the heading and leads through the place, forwards or backwards (pure
/// pursuit).
inline double curvature_to(const Pose2& from, const Eigen::Vector2d& place_m) {
  const Eigen::Vector2d way = place_m - from.place(), forward = from.forward();
  const double left_m = forward.x() * way.y() - forward.y() * way.x();
  return 2 * left_m / std::max(way.squaredNorm(), 1e-6);
}

}  // namespace gvom::planner
