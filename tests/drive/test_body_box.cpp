// The box meets a body if and only if a point of one is in the other: against dense points, by other
// formulas.
#include <cmath>
#include <cstdint>

#include <catch2/catch.hpp>

#include "tests/drive/driven.hpp"
#include "tools/drive/body_box.hpp"
#include "tools/sim/noise.hpp"

using namespace gvom;
using namespace gvom::test;

namespace {

/// Whether the point is in the body grown by `more_m` (shrunk where negative) by a lower or an upper bound:
/// with -d a ball of d around the point is inside, with +d all points within d of the body are in.
bool holds(const sim::Body& body, const Eigen::Vector3d& point, double more_m) {
  if (body.shape == sim::Body::Shape::capsule) {
    double nearest = HUGE_VAL;
    for (int i = 0; i <= 400; ++i)
      nearest = std::min(nearest, (point - body.centre - body.size * i / 400.0).norm());
    return nearest <= body.radius_m + more_m;
  }
  const Eigen::Vector3d local =
      Eigen::AngleAxisd(-body.yaw_rad, Eigen::Vector3d::UnitZ()) * (point - body.centre);
  if (body.shape == sim::Body::Shape::box)
    return (local.cwiseAbs().array() <= body.size.array() + more_m).all();
  const double scaled = local.cwiseQuotient(body.size).norm();
  return scaled <= 1 + more_m / body.size.minCoeff();
}

bool any_point_in(const driving::VehicleModel& model, const Pose& pose, const sim::Body& body,
                  double more_m) {
  constexpr double kPoint_m = 0.05;
  const planner::VehicleLimits& limits = model.limits;
  for (double x = -limits.rear_m; x <= limits.front_m + 1e-9; x += kPoint_m)
    for (double y = -0.5 * limits.width_m; y <= 0.5 * limits.width_m + 1e-9; y += kPoint_m)
      for (double z = limits.ground_clearance_m; z <= limits.height_m + 1e-9; z += kPoint_m) {
        const Eigen::Vector3d at(x, y, z - model.base_height_m);
        if (holds(body, pose.translation_m + pose.rotation * at, more_m)) return true;
      }
  return false;
}

sim::Body draw_body(sim::Random& random) {
  const Eigen::Vector3d centre(random.between(-2, 2), random.between(-2, 2), random.between(-0.5, 2.5));
  sim::Body body;
  body.shape = static_cast<sim::Body::Shape>(random.count(0, 2));
  body.centre = centre;
  body.yaw_rad = random.between(-3, 3);
  body.radius_m = random.between(0.1, 0.5);
  const bool is_capsule = body.shape == sim::Body::Shape::capsule;
  for (double& part : body.size) part = is_capsule ? random.between(-1.5, 1.5) : random.between(0.15, 0.9);
  return body;
}

}  // namespace

TEST_CASE("the box meets what points within it find, and nothing else") {
  sim::Random random(11);
  const driving::VehicleModel model = small_vehicle();
  int met = 0, missed = 0;
  for (int i = 0; i < 150; ++i) {
    Pose pose;
    pose.translation_m = {random.between(-1, 1), random.between(-1, 1), 0.25};
    pose.rotation = Eigen::AngleAxisd(random.between(-3, 3), Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(random.between(-0.4, 0.4), Eigen::Vector3d::UnitY()) *
                    Eigen::AngleAxisd(random.between(-0.4, 0.4), Eigen::Vector3d::UnitX());
    const sim::Body body = draw_body(random);
    const bool meets = driving::BodyBox(model, pose).meets(sim::Primitive(body, 0));
    INFO("case " << i);
    if (any_point_in(model, pose, body, -0.04)) CHECK(meets);
    if (!any_point_in(model, pose, body, 0.05)) CHECK_FALSE(meets);
    ++(meets ? met : missed);
  }
  CHECK(met > 30);
  CHECK(missed > 60);
}
