// Bodies that rays meet: ellipsoids, capsules and boxes, solid or letting some rays through.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "tools/sim/world_data.hpp"

namespace gvom::sim {

/// Metres, odom frame; `direction` is a unit vector.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

/// The part of a ray inside a body, in metres from the ray's origin; empty if `enter > leave`.
struct Interval {
  double enter = std::numeric_limits<double>::infinity();
  double leave = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool empty() const { return enter > leave; }
};

/// A body of the world, with what rays ask of it computed once.
struct Primitive {
  Primitive(const Body& body, int number);

  Body body;
  int object;      ///< Number of the object that this is a part of.
  double cos_yaw;  ///< Of the body's own yaw.
  double sin_yaw;
  Eigen::Vector3d lower;  ///< Corners of its axis-aligned box.
  Eigen::Vector3d upper;

  [[nodiscard]] bool is_solid() const { return body.hits_per_m == std::numeric_limits<double>::infinity(); }
};

/// The whole line of the ray counts, also behind its origin.
Interval intersect(const Primitive& primitive, const Ray& ray);

/// Cosine of the angle between a ray's direction and the surface's normal at a point of the surface.
double cos_incidence(const Primitive& primitive, const Eigen::Vector3d& point,
                     const Eigen::Vector3d& direction);

}  // namespace gvom::sim
