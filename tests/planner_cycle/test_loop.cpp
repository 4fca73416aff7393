// The planner drives a vehicle over maps that do not change.
#include <catch2/catch.hpp>

#include "services/planner/search.hpp"
#include "tests/planner_cycle/loop.hpp"

namespace gvom::test {
namespace {

using Eigen::Vector2d;
using planner::Mode;
using planner::Plan;
using planner::PlannerConfig;

struct Disc {
  Vector2d middle_m;
  double radius_m;
};

// From the vehicle's outline to the discs' rims, by points along the outline.
double nearest_m(const SmallVehicle& vehicle, const std::vector<Disc>& discs) {
  double least_m = 1e9;
  for (int i = -10; i <= 10; ++i)
    for (const double side : {-1.0, 1.0})
      for (const Vector2d& place : {vehicle.outline(i / 10.0, side), vehicle.outline(side, i / 10.0)})
        for (const Disc& disc : discs)
          least_m = std::min(least_m, (place - disc.middle_m).norm() - disc.radius_m);
  return least_m;
}

PlannerConfig car() {
  PlannerConfig config;
  config.vehicle.steering = planner::Steering::ackermann;
  config.vehicle.front_m = 1.9;
  config.vehicle.rear_m = 0.6;
  config.vehicle.front_axle_m = 1.4;
  config.vehicle.rear_axle_m = 0.0;
  config.vehicle.max_curvature_per_m = 0.35;
  return config;
}

TEST_CASE("Between discs it drives a slalom to its goal and touches none") {
  for (const bool steers : {false, true}) {
    const PlannerConfig config = steers ? car() : PlannerConfig{};
    SmallMap map(128);
    std::vector<Disc> discs;
    for (int i = 0; i < 4; ++i) discs.push_back({{14.0 + 6 * i, i % 2 == 0 ? 26.5 : 23.5}, 2.4});
    discs.push_back({{14, 19}, 2});
    discs.push_back({{26, 31}, 2});
    for (const Disc& disc : discs)
      map.obstacle(test::disc(disc.middle_m.x(), disc.middle_m.y(), disc.radius_m));
    Loop loop(config, map, {5, 25, 0});
    loop.planner.set_course({{44, 25}});
    double nearest = 1e9, fastest_mps = 0;
    const bool arrives = loop.until(Mode::arrived, 60, [&](const Plan&) {
      nearest = std::min(nearest, nearest_m(loop.vehicle, discs));
      fastest_mps = std::max(fastest_mps, loop.vehicle.speed_mps());
    });
    CAPTURE(steers, nearest, fastest_mps, loop.vehicle.pose().x_m, loop.vehicle.pose().y_m);
    CHECK(arrives);
    CHECK(nearest > 0);
    CHECK(fastest_mps > 1.5);
  }
}

TEST_CASE("Whenever it has to stop, it stops along what it drove") {
  const PlannerConfig config;
  SmallMap map(128);
  for (const Disc& disc :
       {Disc{{15, 26.4}, 2.4}, Disc{{19.5, 23.2}, 2.2}, Disc{{15, 20}, 2}, Disc{{22, 29.5}, 2.2}})
    map.obstacle(test::disc(disc.middle_m.x(), disc.middle_m.y(), disc.radius_m));
  for (double stop_s = 2; stop_s < 8; stop_s += 0.3) {
    Loop loop(config, map, {5, 25, 0});
    loop.planner.set_course({{44, 25}});
    std::vector<planner::TrajectoryPoint> driven;
    double time_s = 0, farthest_m = 0;
    loop.until(Mode::arrived, stop_s + 4, [&](const Plan& plan) {
      time_s += loop.period_s;
      if (time_s >= stop_s) loop.senses.layers_age_s = 1;
      if (!plan.trajectory.empty()) return driven.assign(plan.trajectory.begin(), plan.trajectory.end());
      const auto off_m = [&](const planner::TrajectoryPoint& point) {
        return (point.pose.place() - loop.vehicle.pose().place()).norm();
      };
      const auto nearest = std::min_element(
          driven.begin(), driven.end(), [&](const auto& a, const auto& b) { return off_m(a) < off_m(b); });
      // It begins where the vehicle is when a command takes effect.
      if (nearest != driven.begin()) farthest_m = std::max(farthest_m, off_m(*nearest));
    });
    CAPTURE(stop_s, farthest_m);
    CHECK(farthest_m < 0.25);  // points are 0.25 m apart
    CHECK(loop.vehicle.speed_mps() == 0);
  }
}

TEST_CASE("Every command and trajectory is within the vehicle's limits") {
  const PlannerConfig config = car();
  SmallMap map(128);
  map.obstacle(disc(20, 25.5, 3));
  map.obstacle(disc(28, 21, 2));
  Loop loop(config, map, {5, 25, 0.5});
  loop.planner.set_course({{30, 40}, {10, 40}});
  int driven = 0;
  loop.until(Mode::arrived, 40, [&](const Plan& plan) {
    REQUIRE(std::abs(plan.command.curvature_per_m) <= config.vehicle.max_curvature_per_m + 1e-9);
    REQUIRE(plan.command.speed_mps <= config.speed_mps);
    for (std::size_t i = 1; i < plan.trajectory.size(); ++i) {
      const planner::TrajectoryPoint &at = plan.trajectory[i], &before = plan.trajectory[i - 1];
      REQUIRE(std::abs(at.curvature_per_m) <= config.vehicle.max_curvature_per_m + 1e-9);
      const double change = std::abs(at.curvature_per_m - before.curvature_per_m) / 0.25;
      REQUIRE(change * at.speed_mps <= config.vehicle.max_curvature_rate_per_m_s + 1e-6);
      REQUIRE(at.speed_mps * at.speed_mps * std::abs(at.curvature_per_m) <=
              config.vehicle.max_lateral_accel_mps2 + 1e-6);
      ++driven;
    }
  });
  CHECK(driven > 1000);
}

TEST_CASE("It drives around a mound that would tip it, though no flag forbids it") {
  const PlannerConfig config;
  SmallMap map(128);
  // 1.5 m high and 6 m wide: up to 0.8 m/m, which is 0.67 rad.
  const auto z_m = [](double x, double y) {
    const double off_m = std::hypot(x - 22, y - 25);
    return off_m < 3 ? 0.75 * (1 + std::cos(off_m / 3 * 3.14159265)) : 0.0;
  };
  map.shape(z_m);
  Loop loop(config, map, {5, 25, 0});
  loop.planner.set_course({{40, 25.3}});
  double most_rad = 0;
  const bool arrives = loop.until(Mode::arrived, 60, [&](const Plan&) {
    // By the heights themselves, under the middles of the bumpers and of the sides.
    const Vector2d front = loop.vehicle.outline(0.625, 0), rear = loop.vehicle.outline(-0.625, 0);
    const Vector2d left = loop.vehicle.outline(0, 0.8), right = loop.vehicle.outline(0, -0.8);
    most_rad = std::max({most_rad, std::abs(z_m(front.x(), front.y()) - z_m(rear.x(), rear.y())) / 1.0,
                         std::abs(z_m(left.x(), left.y()) - z_m(right.x(), right.y())) / 1.12});
  });
  CAPTURE(loop.vehicle.pose().x_m, loop.vehicle.pose().y_m);
  CHECK(arrives);
  CHECK(most_rad < 0.5);
  CHECK(most_rad > 0.01);  // it touches its foot
}

TEST_CASE("A course of three waypoints is driven through without a stop") {
  SmallMap map(128);
  Loop loop({}, map, {5, 10, 0});
  loop.planner.set_course({{20, 12}, {32, 22}, {32, 42}});
  double slowest_mps = 9;
  std::size_t waypoint = 0;
  const bool arrives = loop.until(Mode::arrived, 40, [&](const Plan& plan) {
    if (plan.waypoint == 1) slowest_mps = std::min(slowest_mps, loop.vehicle.speed_mps());
    waypoint = std::max(waypoint, plan.waypoint);
  });
  CHECK(arrives);
  CHECK(waypoint == 2);
  CHECK(slowest_mps > 1.0);
}

// A wall from y 12 to the map's border between it and its goal: the way is behind it, however fast it drives.
TEST_CASE("At full speed along a wall it turns back where the way is behind it, and soon") {
  const PlannerConfig config;
  SmallMap map(128);
  map.obstacle(box(31, 12, 32, 51));
  Loop loop(config, map, {25, 14, 1.5707963});
  loop.planner.set_course({{25, 45}});
  for (int i = 0; i < 40; ++i) loop.step();
  REQUIRE(loop.vehicle.speed_mps() > 4);
  const double turned_m = loop.vehicle.pose().y_m;
  loop.planner.set_course({{42, 26}});
  double farthest_m = 0;
  CHECK(loop.until(Mode::arrived, 40, [&](const Plan&) {
    farthest_m = std::max(farthest_m, loop.vehicle.pose().y_m - turned_m);
  }));
  CAPTURE(turned_m, farthest_m);
  CHECK(farthest_m < 7.5);
}

}  // namespace
}  // namespace gvom::test
