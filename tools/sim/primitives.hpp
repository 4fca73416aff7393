// Bodies that rays meet: ellipsoids and capsules, solid or letting some rays through.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

namespace gvom::sim {

/// What stands in a column of the truth. The numbers are those in `class.npy`.
enum class ObjectClass : std::uint8_t {
  ground = 0,
  tree = 1,
  bush = 2,
  rock = 3,
  ditch = 4,
  step_face = 5,
  overhang = 6,
  person = 7,
};

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

/// A convex body. `absorption_per_m` is the rate at which rays end inside: infinite for a solid.
struct Primitive {
  enum class Shape : std::uint8_t { ellipsoid, capsule };

  Shape shape = Shape::ellipsoid;
  std::uint8_t reflectivity = 0;
  int object = -1;         ///< Index of the object that this is a part of.
  Eigen::Vector3d centre;  ///< Of the ellipsoid; of the capsule's first end.
  Eigen::Vector3d size;    ///< The ellipsoid's radii; from the capsule's first end to its second.
  double radius_m = 0.0;   ///< The capsule's.
  double absorption_per_m = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_solid() const { return absorption_per_m == std::numeric_limits<double>::infinity(); }
};

/// The whole line of the ray counts, also behind its origin.
Interval intersect(const Primitive& body, const Ray& ray);

/// Corners of the body's axis-aligned box.
Eigen::Vector3d lower_corner(const Primitive& body);
Eigen::Vector3d upper_corner(const Primitive& body);

}  // namespace gvom::sim
