// The way of the vehicle through a scene.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace gvom::sim {

/// Worlds reach this far beyond the driven path.
inline constexpr double kAround = 55.0;

/// Scenes with an end (a ditch, a cliff, a wall across) stop this far along; the end begins 3 m further on.
inline constexpr double kEndingPath = 40.0;
inline constexpr double kEnd = kEndingPath + 3.05;  // between two nodes of the height map

/// Corners of polylines in odom, metres.
struct Course {
  std::vector<Eigen::Vector2d> path_m;   ///< What is driven, from (0, 0).
  std::vector<Eigen::Vector2d> trail_m;  ///< The same way on to both ends of the world: kept free of things.
};

Course straight_course(double length_m);

/// Swings about the x axis by `swing_m` with a wave length of 60 m.
Course winding_course(double length_m, double swing_m);

/// Of a point from the nearest place on the polyline.
double distance_to(const std::vector<Eigen::Vector2d>& line_m, const Eigen::Vector2d& point_m);

/// y of the polyline at x; its corners must go along x.
double y_on(const std::vector<Eigen::Vector2d>& line_m, double x_m);

/// To 1/4096 m, so that the last bits of a C library's sine don't matter.
double quantised(double length_m);

}  // namespace gvom::sim
