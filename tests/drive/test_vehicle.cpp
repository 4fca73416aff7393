// The vehicle drives as geometry and its data sheet say.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/drive/driven.hpp"

using namespace gvom;
using namespace gvom::driving;
using namespace gvom::test;

namespace {

const sim::World& level() {
  static const sim::World the_world(level_world());
  return the_world;
}

/// The largest difference from a circle of the radius about the point to the left, over `seconds`.
double off_circle_m(Vehicle& vehicle, const planner::Command& command, double radius_m, double seconds) {
  const Eigen::Vector2d forward = vehicle.state().place.forward();
  const Eigen::Vector2d middle =
      vehicle.state().place.place() + radius_m * Eigen::Vector2d(-forward.y(), forward.x());
  double worst_m = 0;
  for (double time = 0; time < seconds; time += 0.1) {
    drive(vehicle, command, 0.1);
    const double distance_m = (vehicle.state().place.place() - middle).norm();
    worst_m = std::max(worst_m, std::abs(distance_m - radius_m));
  }
  return worst_m;
}

}  // namespace

TEST_CASE("at a curvature of 0.2 a car drives a circle of 5 m") {
  Vehicle vehicle(level().terrain(), small_vehicle(), {0, 0, 0.3});
  const planner::Command command{2, 0.2};
  drive(vehicle, command, 5);  // until speed and steering are there
  CHECK(off_circle_m(vehicle, command, 5, 15.708) < 0.001);
}

TEST_CASE("a skid-steer vehicle loses a tenth of its yaw rate: the circle is wider") {
  Vehicle vehicle(level().terrain(), small_vehicle(planner::Steering::skid_steer), {0, 0, -2});
  const planner::Command command{2, 0.2};
  drive(vehicle, command, 5);
  CHECK(off_circle_m(vehicle, command, 5 / 0.9, 15) < 0.001);
}

TEST_CASE("it stops after the delay, the braking and the last of the actuator") {
  Vehicle vehicle(level().terrain(), small_vehicle(), {});
  drive(vehicle, {4, 0}, 6);
  REQUIRE(vehicle.state().speed_mps == Approx(4).epsilon(1e-6));
  const double from_m = vehicle.state().place.x_m;
  drive(vehicle, {0, 0}, 4);
  // 4 m/s for 0.1 s; down to a tau = 2.5 * 0.2 m/s at 2.5 m/s^2; then that speed times tau.
  const double stopping_m = 4 * 0.1 + (16 - 0.25) / (2 * 2.5) + 0.5 * 0.2;
  CHECK(vehicle.state().speed_mps == 0);
  CHECK(vehicle.state().place.x_m - from_m == Approx(stopping_m).margin(0.04));  // a step is 0.04 m
}

TEST_CASE("commands come through the delay, and limits hold whatever is commanded") {
  Vehicle vehicle(level().terrain(), small_vehicle(), {});
  const planner::VehicleLimits& limits = vehicle.model().limits;
  vehicle.command(0, {100, 100});
  for (int i = 0; i < 10; ++i) vehicle.step();
  CHECK(vehicle.state().speed_mps == 0);
  double speed = 0, curvature = 0;
  for (int i = 0; i < 800; ++i) {
    vehicle.command(vehicle.time_s(), {100, 100});
    vehicle.step();
    CHECK(vehicle.state().speed_mps - speed <= limits.max_accel_mps2 * kStep_s + 1e-12);
    CHECK(vehicle.state().curvature_per_m - curvature <= limits.max_curvature_rate_per_m_s * kStep_s + 1e-12);
    speed = vehicle.state().speed_mps;
    curvature = vehicle.state().curvature_per_m;
  }
  CHECK(speed == Approx(limits.max_speed_mps).epsilon(1e-3));
  CHECK(curvature == Approx(limits.max_curvature_per_m));
}

TEST_CASE("without commands it brakes after half a second and the delay") {
  Vehicle vehicle(level().terrain(), small_vehicle(), {});
  drive(vehicle, {3, 0}, 5);
  const double silent_s = vehicle.time_s() - 0.1;  // of the last command
  while (vehicle.time_s() < silent_s + 0.6) vehicle.step();
  CHECK(vehicle.state().speed_mps == Approx(3).epsilon(1e-4));
  for (int i = 0; i < 300; ++i) vehicle.step();
  CHECK(vehicle.state().speed_mps == 0);
}

TEST_CASE("slopes: slower uphill, sideways across, braking downhill takes longer") {
  const double slope = 0.2;
  const sim::World world(shaped_world([&](double x, double) { return slope * x; }));
  const double sine = std::sin(std::atan(slope));

  Vehicle up(world.terrain(), small_vehicle(), {});
  drive(up, {3, 0}, 5);
  CHECK(up.state().speed_mps == Approx(3 * (1 - 0.3 * sine)).epsilon(1e-4));
  const double from_x_m = up.state().place.x_m;
  drive(up, {3, 0}, 1);
  CHECK(up.state().place.x_m - from_x_m ==
        Approx(up.state().speed_mps * std::cos(std::atan(slope))).epsilon(1e-4));

  Vehicle across(world.terrain(), small_vehicle(), {0, -20, M_PI / 2});
  drive(across, {3, 0}, 5);
  const planner::Pose2 before = across.state().place;
  drive(across, {3, 0}, 1);
  CHECK(across.state().place.y_m - before.y_m == Approx(3).epsilon(1e-3));
  CHECK(across.state().place.x_m - before.x_m == Approx(-0.1 * 3 * sine).epsilon(1e-3));

  const double steep = std::tan(25 * M_PI / 180);
  const sim::World hill(shaped_world([&](double x, double) { return -steep * x; }));
  Vehicle down(hill.terrain(), small_vehicle(), {});
  drive(down, {4, 0}, 6);
  const double from_m = down.state().place.x_m;
  drive(down, {0, 0}, 6);
  // What grip is left of 0.6 at 25 degrees: 1.189 m/s^2.
  const double brake = 9.81 * (0.6 * std::cos(25 * M_PI / 180) - std::sin(25 * M_PI / 180));
  const double last_mps = 0.2 * brake;
  const double stopping_m = 4 * 0.1 + (16 - last_mps * last_mps) / (2 * brake) + last_mps * 0.2;
  CHECK(down.state().speed_mps == 0);
  CHECK((down.state().place.x_m - from_m) / std::cos(25 * M_PI / 180) == Approx(stopping_m).margin(0.05));
}

TEST_CASE("it stands on a plane as the plane leans, whatever its heading") {
  const sim::World world(shaped_world([](double x, double y) { return 0.1 * x + 0.2 * y; }));
  for (const double yaw : {0.0, 0.7, M_PI / 2, 2.5, -2.0}) {
    const planner::Pose2 place{3, -4, yaw};
    const VehicleModel model = small_vehicle();
    const Stance stance = stand(world.terrain(), model, place);
    const double ahead = 0.1 * std::cos(yaw) + 0.2 * std::sin(yaw);
    const double left = -0.1 * std::sin(yaw) + 0.2 * std::cos(yaw);
    // A wheel touches the slope with its tread before its lowest point, and with the edge of its tyre.
    const double higher_m = 0.3 * (std::sqrt(1 + ahead * ahead) - 1) + 0.125 * std::abs(left);
    CHECK(stance.ground_m == Approx(0.1 * 3 - 0.2 * 4 + higher_m).margin(0.001));
    CHECK(stance.pitch_rad == Approx(-std::atan(ahead)).margin(1e-5));
    CHECK(stance.roll_rad == Approx(std::atan(left)).margin(1e-5));
    CHECK(belly_ground_m(world.terrain(), model, place, stance) == Approx(-higher_m).margin(0.001));
    const Pose pose = pose_of(model, place, stance);
    CHECK(pose.translation_m.z() == Approx(stance.ground_m + 0.25));
    const Eigen::Vector3d forward = pose.rotation * Eigen::Vector3d::UnitX();
    CHECK(std::atan2(forward.y(), forward.x()) == Approx(yaw).margin(1e-12));
    CHECK(forward.z() == Approx(-std::sin(stance.pitch_rad)).margin(1e-12));
  }
}

TEST_CASE("a wheel over a hole is in it") {
  sim::WorldData data = level_world();
  paint(data, {0.2, 0.2}, {0.9, 0.9}, sim::Surface::hole, -0.2);  // below the front left wheel
  const sim::World world(std::move(data));
  const Stance stance = stand(world.terrain(), small_vehicle(), {});
  CHECK(stance.wheel_m[kFrontLeft] == Approx(-0.2).margin(1e-6));
  CHECK_FALSE(stance.is_firm[kFrontLeft]);
  CHECK(stance.is_firm[kFrontRight]);
  CHECK(stance.ground_m == Approx(-0.05).margin(1e-6));
  CHECK(stance.pitch_rad == Approx(std::atan(0.1 / 1.0)).margin(1e-6));
  CHECK(stance.roll_rad == Approx(-std::atan(0.1 / 1.1)).margin(1e-6));
}

TEST_CASE("its motion is known for all times of its steps, and in between") {
  Vehicle vehicle(level().terrain(), small_vehicle(), {});
  drive(vehicle, {3, 0.1}, 2);
  const Pose then = vehicle.at(1.5), next = vehicle.at(1.51), between = vehicle.at(1.505);
  CHECK((between.translation_m - 0.5 * (then.translation_m + next.translation_m)).norm() < 1e-9);
  CHECK(between.rotation.angularDistance(then.rotation) ==
        Approx(0.5 * then.rotation.angularDistance(next.rotation)).epsilon(1e-3));
  CHECK(vehicle.at(-0.05).translation_m == vehicle.at(0).translation_m);
  CHECK(vehicle.at(vehicle.time_s()).translation_m == vehicle.T_odom_base().translation_m);
}
