#include "tools/sim/primitives.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::sim {
namespace {

constexpr double kEverywhere = std::numeric_limits<double>::infinity();

/// Where a t^2 + 2 b t + c <= 0, for a >= 0.
Interval solve(double a, double b, double c) {
  if (a < 1e-12) return c <= 0.0 ? Interval{-kEverywhere, kEverywhere} : Interval{};
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return {};
  const double root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

/// Where low <= at + t speed <= high.
Interval between(double at, double speed, double low, double high) {
  if (std::abs(speed) < 1e-12)
    return at >= low && at <= high ? Interval{-kEverywhere, kEverywhere} : Interval{};
  const double first = (low - at) / speed;
  const double second = (high - at) / speed;
  return {std::min(first, second), std::max(first, second)};
}

/// A vector turned from odom into the body's own axes, and back.
Eigen::Vector3d into_body(const Primitive& p, const Eigen::Vector3d& v) {
  return {p.cos_yaw * v.x() + p.sin_yaw * v.y(), p.cos_yaw * v.y() - p.sin_yaw * v.x(), v.z()};
}

Interval intersect_sphere(const Eigen::Vector3d& centre, double radius_m, const Ray& ray) {
  const Eigen::Vector3d from_centre = ray.origin - centre;
  return solve(1.0, from_centre.dot(ray.direction), from_centre.squaredNorm() - radius_m * radius_m);
}

Interval intersect_ellipsoid(const Primitive& p, const Ray& ray) {
  const Eigen::Array3d scale = p.body.size.array().inverse();
  const Eigen::Vector3d origin = (into_body(p, ray.origin - p.body.centre).array() * scale).matrix();
  const Eigen::Vector3d direction = (into_body(p, ray.direction).array() * scale).matrix();
  return solve(direction.squaredNorm(), origin.dot(direction), origin.squaredNorm() - 1.0);
}

Interval intersect_box(const Primitive& p, const Ray& ray) {
  const Eigen::Vector3d origin = into_body(p, ray.origin - p.body.centre);
  const Eigen::Vector3d direction = into_body(p, ray.direction);
  Interval whole{-kEverywhere, kEverywhere};
  for (int axis = 0; axis < 3; ++axis) {
    const double half = p.body.size[axis];
    const Interval slab = between(origin[axis], direction[axis], -half, half);
    whole = {std::max(whole.enter, slab.enter), std::min(whole.leave, slab.leave)};
    if (whole.empty()) return {};
  }
  return whole;
}

Interval intersect_capsule(const Primitive& p, const Ray& ray) {
  const Body& body = p.body;
  const double length = body.size.norm();
  if (length < 1e-9) return intersect_sphere(body.centre, body.radius_m, ray);
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
  const Interval slab = between(along, speed, 0.0, length);
  Interval whole{std::max(tube.enter, slab.enter), std::min(tube.leave, slab.leave)};
  if (whole.empty()) whole = {};
  for (const Eigen::Vector3d& end : {body.centre, Eigen::Vector3d(body.centre + body.size)}) {
    const Interval ball = intersect_sphere(end, body.radius_m, ray);
    whole.enter = std::min(whole.enter, ball.enter);
    whole.leave = std::max(whole.leave, ball.leave);
  }
  return whole;
}

/// Half the edges of the axis-aligned box around an ellipsoid or a box.
Eigen::Vector3d half_extent(const Body& body, double cosine, double sine) {
  const Eigen::Array2d x(cosine * body.size.x(), sine * body.size.x());
  const Eigen::Array2d y(sine * body.size.y(), cosine * body.size.y());
  const Eigen::Array2d half =
      body.shape == Body::Shape::box ? (x.abs() + y.abs()).eval() : (x.square() + y.square()).sqrt().eval();
  return {half.x(), half.y(), body.size.z()};
}

/// Outwards, of any length, at a point of the surface.
Eigen::Vector3d normal_at(const Primitive& p, const Eigen::Vector3d& point) {
  const Body& body = p.body;
  if (body.shape == Body::Shape::capsule) {
    const double along = (point - body.centre).dot(body.size) / std::max(body.size.squaredNorm(), 1e-18);
    return point - body.centre - std::clamp(along, 0.0, 1.0) * body.size;
  }
  const Eigen::Array3d inside = into_body(p, point - body.centre).array() / body.size.array();
  Eigen::Vector3d normal = (inside / body.size.array()).matrix();
  if (body.shape == Body::Shape::box) {
    int face = 0;
    inside.abs().maxCoeff(&face);
    normal = Eigen::Vector3d::Unit(face);
  }
  return {p.cos_yaw * normal.x() - p.sin_yaw * normal.y(), p.sin_yaw * normal.x() + p.cos_yaw * normal.y(),
          normal.z()};
}

}  // namespace

Primitive::Primitive(const Body& the_body, int number)
    : body(the_body),
      object(number),
      cos_yaw(std::cos(the_body.yaw_rad)),
      sin_yaw(std::sin(the_body.yaw_rad)) {
  if (body.shape == Body::Shape::capsule) {
    const Eigen::Vector3d end = body.centre + body.size;
    lower = body.centre.cwiseMin(end) - Eigen::Vector3d::Constant(body.radius_m);
    upper = body.centre.cwiseMax(end) + Eigen::Vector3d::Constant(body.radius_m);
  } else {
    const Eigen::Vector3d half = half_extent(body, cos_yaw, sin_yaw);
    lower = body.centre - half;
    upper = body.centre + half;
  }
}

Interval intersect(const Primitive& primitive, const Ray& ray) {
  switch (primitive.body.shape) {
    case Body::Shape::ellipsoid:
      return intersect_ellipsoid(primitive, ray);
    case Body::Shape::capsule:
      return intersect_capsule(primitive, ray);
    case Body::Shape::box:
      return intersect_box(primitive, ray);
  }
  return {};
}

double cos_incidence(const Primitive& primitive, const Eigen::Vector3d& point,
                     const Eigen::Vector3d& direction) {
  return std::abs(normal_at(primitive, point).normalized().dot(direction));
}

}  // namespace gvom::sim
