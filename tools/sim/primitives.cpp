#include "tools/sim/primitives.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::sim {
namespace {

/// Where a t^2 + 2 b t + c <= 0, for a >= 0.
Interval solve(double a, double b, double c) {
  if (a < 1e-12)
    return c <= 0.0
               ? Interval{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}
               : Interval{};
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return {};
  const double root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

Interval intersect_sphere(const Eigen::Vector3d& centre, double radius_m, const Ray& ray) {
  const Eigen::Vector3d from_centre = ray.origin - centre;
  return solve(1.0, from_centre.dot(ray.direction), from_centre.squaredNorm() - radius_m * radius_m);
}

Interval intersect_ellipsoid(const Primitive& body, const Ray& ray) {
  const Eigen::Array3d scale = body.size.array().inverse();
  const Eigen::Vector3d origin = ((ray.origin - body.centre).array() * scale).matrix();
  const Eigen::Vector3d direction = (ray.direction.array() * scale).matrix();
  return solve(direction.squaredNorm(), origin.dot(direction), origin.squaredNorm() - 1.0);
}

/// The part of the ray between the planes through the capsule's ends; `along` and `speed` are the
/// ray's position and direction along the axis.
Interval between_ends(double along, double speed, double length) {
  if (std::abs(speed) < 1e-12) return along >= 0.0 && along <= length ? solve(0.0, 0.0, 0.0) : Interval{};
  const double first = -along / speed;
  const double second = (length - along) / speed;
  return {std::min(first, second), std::max(first, second)};
}

Interval intersect_capsule(const Primitive& body, const Ray& ray) {
  const double length = body.size.norm();
  const Eigen::Vector3d axis = body.size / length;
  const Eigen::Vector3d from_end = ray.origin - body.centre;
  const double along = from_end.dot(axis);
  const double speed = ray.direction.dot(axis);
  const Eigen::Vector3d across = from_end - along * axis;
  const Eigen::Vector3d across_speed = ray.direction - speed * axis;
  const Interval tube = solve(across_speed.squaredNorm(), across.dot(across_speed),
                              across.squaredNorm() - body.radius_m * body.radius_m);
  if (tube.empty()) return {};

  // The body is convex, so its interval is the hull of those of its three parts.
  const Interval slab = between_ends(along, speed, length);
  Interval whole{std::max(tube.enter, slab.enter), std::min(tube.leave, slab.leave)};
  if (whole.empty()) whole = {};
  for (const Eigen::Vector3d& end : {body.centre, Eigen::Vector3d(body.centre + body.size)}) {
    const Interval ball = intersect_sphere(end, body.radius_m, ray);
    whole.enter = std::min(whole.enter, ball.enter);
    whole.leave = std::max(whole.leave, ball.leave);
  }
  return whole;
}

}  // namespace

Interval intersect(const Primitive& body, const Ray& ray) {
  return body.shape == Primitive::Shape::ellipsoid ? intersect_ellipsoid(body, ray)
                                                   : intersect_capsule(body, ray);
}

Eigen::Vector3d lower_corner(const Primitive& body) {
  if (body.shape == Primitive::Shape::ellipsoid) return body.centre - body.size;
  return body.centre.cwiseMin(body.centre + body.size) - Eigen::Vector3d::Constant(body.radius_m);
}

Eigen::Vector3d upper_corner(const Primitive& body) {
  if (body.shape == Primitive::Shape::ellipsoid) return body.centre + body.size;
  return body.centre.cwiseMax(body.centre + body.size) + Eigen::Vector3d::Constant(body.radius_m);
}

}  // namespace gvom::sim
