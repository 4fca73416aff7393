// What it does where nothing leads on.
#include <catch2/catch.hpp>

#include "services/planner/trail.hpp"
#include "tests/planner_cycle/loop.hpp"

namespace gvom::test {
namespace {

using planner::Mode;
using planner::Plan;
using planner::PlannerConfig;
using planner::Reason;

PlannerConfig long_vehicle() {
  PlannerConfig config;
  config.vehicle.front_m = 2.6;
  config.vehicle.rear_m = 0.8;
  config.vehicle.front_axle_m = 2.0;
  config.vehicle.rear_axle_m = 0.0;
  config.vehicle.width_m = 1.4;
  config.vehicle.max_curvature_per_m = 0.25;
  return config;
}

TEST_CASE("It backs out of a dead end that showed late, and arrives by the other way") {
  // A lane 2.8 m wide, in which it cannot turn. Its mouth is in a wall that is open at one end.
  SmallMap map(128);
  map.obstacle(box(12, 26.4, 12.8, 52));
  map.obstacle(box(12, 6, 12.8, 23.6));
  map.obstacle(box(12, 26.4, 30, 27.2));
  map.obstacle(box(12, 22.8, 30, 23.6));
  PlannerConfig config;
  config.costmap.near_weight = 1;  // else it goes around at once
  Loop loop(config, map, {5, 25, 0});
  loop.planner.set_course({{42, 25}});
  double backed_m = 0, farthest_m = 0;
  bool shown = false;
  const bool arrives = loop.until(Mode::arrived, 120, [&](const Plan& plan) {
    const double front_m = loop.vehicle.outline(1, 0).x();
    if (front_m > 22 && !shown) {
      map.obstacle(box(29.2, 22.8, 30, 27.2));
      shown = true;
    }
    if (backed_m == 0) farthest_m = std::max(farthest_m, front_m);
    if (plan.mode != Mode::back) return;
    backed_m += -loop.vehicle.speed_mps() * 0.1;
    CHECK(plan.reason == Reason::dead_end);
    CHECK_THAT(plan.why, Catch::Contains("backs out of a dead end"));
  });
  CAPTURE(loop.vehicle.pose().x_m, loop.vehicle.pose().y_m);
  CHECK(arrives);
  CHECK(farthest_m < 29.2);
  CHECK(backed_m > farthest_m - 14);  // out of the lane's mouth
}

/// A lane that only the search believes to lead on: its end is a slit for a vehicle that can turn on the
/// spot.
struct Lane {
  explicit Lane(const PlannerConfig& config) : loop(config, map, {5, 25, 0}) {
    map.obstacle(box(0, 26.8, 28, 52));
    map.obstacle(box(0, 0, 26, 23.2));
    map.obstacle(box(28.4, 18, 29.2, 52));
    map.obstacle(box(25.6, 18, 26.4, 23.2));
    loop.planner.set_course({{36, 14}});
  }
  SmallMap map{128};
  Loop loop;
};

TEST_CASE("It backs no farther than it may, and not where no lidar looks") {
  for (const bool blind : {false, true}) {
    PlannerConfig config = long_vehicle();
    config.back_out_m = 3;
    config.give_up_s = 12;
    Lane lane(config);
    Loop& loop = lane.loop;
    loop.senses.blind_behind = blind;
    double farthest_m = 0, backed_m = 0, most_backed_m = 0;
    Mode last = Mode::stop;
    loop.until(Mode::gave_up, 60, [&](const Plan& plan) {
      farthest_m = std::max(farthest_m, loop.vehicle.pose().x_m);
      if (plan.mode == Mode::back && last != Mode::back) backed_m = 0;
      backed_m += std::max(0.0, -loop.vehicle.speed_mps() * 0.1);
      most_backed_m = std::max(most_backed_m, backed_m);
      last = plan.mode;
    });
    CAPTURE(blind, farthest_m, loop.vehicle.pose().x_m, most_backed_m);
    CHECK(most_backed_m < 3.6);
    CHECK((most_backed_m > 2) == !blind);
    if (blind) CHECK_THAT(loop.step().why, Catch::Contains("gave up"));
  }
}

TEST_CASE("a retreat ends where the rear goes blind, or a new course comes, and forward is tried again") {
  for (const bool blind : {true, false}) {
    PlannerConfig config = long_vehicle();
    config.give_up_s = 12;
    Lane lane(config);
    Loop& loop = lane.loop;
    REQUIRE(loop.until(Mode::back, 30));
    if (blind) loop.senses.blind_behind = true;
    if (!blind) loop.planner.set_course({{36, 14}});
    int backs = 0;
    const bool gives_up = loop.until(Mode::gave_up, blind ? 60 : 1, [&](const Plan& plan) {
      if (plan.mode == Mode::back) ++backs;
    });
    CHECK(backs == 0);
    CHECK(gives_up == blind);
  }
}

TEST_CASE("poses that are a little older than those before do not restart its patience") {
  PlannerConfig config = long_vehicle();
  config.rate_hz = 50;
  Lane lane(config);
  lane.loop.falls_back_each = 3;
  CHECK(lane.loop.until(Mode::back, 30));
}

TEST_CASE("a clock that leaps restarts its patience: it neither backs at once nor never") {
  for (const std::int64_t leap_ns : {3'600'000'000'000, -1'800'000'000'000}) {
    Lane lane(long_vehicle());
    const auto stands = [&](const Plan& plan) {
      return plan.reason == Reason::no_trajectory && lane.loop.vehicle.speed_mps() == 0;
    };
    bool blocked = false;
    for (int i = 0; i < 300 && !blocked; ++i) blocked = stands(lane.loop.step());
    REQUIRE(blocked);
    lane.loop.ahead_ns = leap_ns;
    for (int i = 0; i < 8; ++i) CHECK(lane.loop.step().mode != Mode::back);
    CHECK(lane.loop.until(Mode::back, 3));
  }
}

TEST_CASE("The trail leads back along the way that was driven") {
  planner::Trail trail;
  for (int i = 0; i <= 200; ++i) trail.add({0.25 * i, 0, 0}, false);
  CHECK(trail.length_m() == Approx(99 * 0.25));
  CHECK(trail.curvature_back({50, 0, 0}) == Approx(0).margin(1e-9));
  // On a circle of 5 m to the left, driven backwards, the same circle.
  planner::Trail circle;
  for (int i = 0; i <= 40; ++i)
    circle.add({5 * std::sin(i * 0.04), 5 - 5 * std::cos(i * 0.04), i * 0.04}, false);
  CHECK(circle.curvature_back({5 * std::sin(1.6), 5 - 5 * std::cos(1.6), 1.6}) == Approx(0.2).epsilon(1e-6));
  // What is backed over is forgotten.
  trail.add({40, 0, 0}, true);
  CHECK(trail.length_m() == Approx(39.75 - 25.25));
}

}  // namespace
}  // namespace gvom::test
