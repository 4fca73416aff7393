// When the planner stops, and what it says.
#include <catch2/catch.hpp>

#include "services/planner/course.hpp"
#include "tests/planner_cycle/loop.hpp"

namespace gvom::test {
namespace {

using planner::Mode;
using planner::Plan;
using planner::PlannerConfig;
using planner::Reason;

// A flat map of 51 m, from which 8 m to drive.
struct Flat {
  SmallMap map{128};
  PlannerConfig config;
  Loop loop{config, map, {10, 25, 0}};
};

void check_stop(const Plan& plan, Reason reason, const std::string& words) {
  CHECK(plan.mode == Mode::stop);
  CHECK(plan.reason == reason);
  CHECK(plan.command.speed_mps == 0);
  CHECK_THAT(plan.why, Catch::Contains(words));
}

TEST_CASE("Without a course it stands") {
  Flat flat;
  check_stop(flat.loop.step(), Reason::no_course, "no course");
}

TEST_CASE("Without layers, or with old ones, it stops") {
  Flat flat;
  flat.loop.planner.set_course({{40, 25}});
  for (int i = 0; i < 20; ++i) flat.loop.step();
  CHECK(flat.loop.vehicle.speed_mps() > 1);
  flat.loop.senses.layers_age_s = 0.8;
  check_stop(flat.loop.step(), Reason::stale_layers, "0.80 s old, more than 0.50 s");
  check_stop(flat.loop.planner.cycle(nullptr, flat.loop.vehicle.state(), {}), Reason::no_layers, "no layers");
  flat.loop.senses.layers_age_s = 0.1;
  CHECK(flat.loop.step().mode == Mode::drive);
}

TEST_CASE("Where there is no way the rest of it costs infinity, also before the first") {
  Flat flat;
  CHECK(flat.loop.step().cost_to_go == Plan::kNoWay);
  flat.loop.planner.set_course({{40, 25}});
  CHECK(flat.loop.step().cost_to_go == Approx(30).epsilon(0.1));
  flat.map.obstacle(box(20, 0, 21, 52));
  const Plan& plan = flat.loop.step();
  CHECK(plan.reason == Reason::no_way);
  CHECK(plan.cost_to_go == Plan::kNoWay);
}

TEST_CASE("Path and trajectory lie on the ground, and where none is known as high as before") {
  Flat flat;
  flat.map.shape([](double x, double) { return 8 + 0.05 * (x - 10); });
  flat.map.hide(box(19, 0, 52, 52));
  flat.loop.planner.set_course({{40, 25}});
  for (int i = 0; i < 10; ++i) flat.loop.step();
  const Plan& plan = flat.loop.step();
  const auto check = [](double x_m, double z_m) {
    CAPTURE(x_m);
    CHECK(z_m == Approx(8 + 0.05 * (std::min(x_m, 18.8) - 10)).margin(0.05));
  };
  REQUIRE(plan.path.size() > 20);
  REQUIRE(plan.trajectory.size() > 20);
  for (const auto& point : plan.path) check(point.pose.x_m, point.z_m);
  for (const auto& point : plan.trajectory) check(point.pose.x_m, point.z_m);
}

TEST_CASE("It does not drive where no lidar looks") {
  Flat flat;
  flat.loop.planner.set_course({{40, 25}});
  flat.loop.senses.blind_ahead = true;
  check_stop(flat.loop.step(), Reason::blind_side, "no lidar that looks ahead");
  flat.loop.senses = {};
  flat.loop.senses.blind_behind = true;
  CHECK(flat.loop.step().mode == Mode::drive);
}

TEST_CASE("After a jump of odometry only a map from after it is driven by, and from a stand") {
  Flat flat;
  flat.loop.planner.set_course({{40, 25}});
  for (int i = 0; i < 10; ++i) flat.loop.step();
  const planner::State state = flat.loop.vehicle.state();
  const planner::MapView before = flat.map.view(state.stamp_ns - 200'000'000);
  planner::Senses jumped;
  jumped.odometry_jumped = true;
  check_stop(flat.loop.planner.cycle(&before, state, jumped), Reason::odometry_jump, "0.20 s older");
  check_stop(flat.loop.planner.cycle(&before, state, {}), Reason::odometry_jump, "odometry jumped");
  const planner::MapView after = flat.map.view(state.stamp_ns + 1);
  check_stop(flat.loop.planner.cycle(&after, state, {}), Reason::odometry_jump, "goes on from a stand");
  REQUIRE(flat.loop.vehicle.speed_mps() > 0.5);
  REQUIRE(flat.loop.until(Mode::drive, 5));
  CHECK(flat.loop.vehicle.speed_mps() < 0.1);
}

/// On an arc to the left at speed.
struct Bend : Flat {
  Bend() {
    loop.planner.set_course({{16, 35}});
    while (loop.vehicle.speed_mps() < 1.5 || curvature_per_m < 0.2)
      curvature_per_m = loop.step().command.curvature_per_m;
  }
  double curvature_per_m = 0;
};

TEST_CASE("Where nobody knows where it is, it brakes on the arc that it drove, and plans on from there") {
  Bend bend;
  for (int i = 0; i < 5; ++i) {
    const Plan& plan = bend.loop.planner.stand(Reason::no_odometry, "no odometry for 0.3 s");
    check_stop(plan, Reason::no_odometry, "no odometry for 0.3 s");
    CHECK(plan.command.curvature_per_m == bend.curvature_per_m);
    CHECK(plan.trajectory.empty());
    bend.loop.vehicle.drive(plan.command, bend.loop.period_s);
  }
  // The commands on their way are to stand: at first it drives no faster than it speeds up in a cycle.
  const double speed_mps = bend.loop.vehicle.speed_mps();
  const double more_mps = bend.config.vehicle.max_accel_mps2 * bend.loop.period_s;
  CHECK(bend.loop.step().command.speed_mps <= speed_mps + more_mps);
  CHECK(bend.loop.until(Mode::arrived, 20));
}

TEST_CASE("After a cycle that took too long it brakes on its arc") {
  Bend bend;
  bend.loop.senses.overrun_s = 0.123;
  const Plan& plan = bend.loop.step();
  check_stop(plan, Reason::overrun, "the last cycle took 123 ms");
  CHECK(plan.command.curvature_per_m > 0.1);
  bend.loop.senses.overrun_s = 0;
  CHECK(bend.loop.step().mode == Mode::drive);
}

TEST_CASE("Layers larger than it was made for are none") {
  SmallMap map(64), large(128);
  planner::Planner planner({}, 64);
  planner.set_course({{20, 12}});
  planner::State state;
  state.T_odom_base.translation_m = {10, 12, 0};
  planner::MapView view = large.view();
  check_stop(planner.cycle(&view, state, {}), Reason::no_layers,
             "128 x 128 columns, the vehicle's file says 64");
  view = map.view();
  CHECK(planner.cycle(&view, state, {}).mode == Mode::drive);
}

TEST_CASE("A wall across the map leaves no way, and after a while it gives up") {
  Flat flat;
  flat.config.give_up_s = 5;
  flat.map.obstacle(box(25, 0, 26.2, 52));
  Loop loop(flat.config, flat.map, {10, 25, 0});
  loop.planner.set_course({{40, 25}});
  check_stop(loop.step(), Reason::no_way, "no way to the waypoint, waypoint 0, 30.0 m away");
  CHECK_FALSE(loop.until(Mode::gave_up, 4.8));
  CHECK(loop.until(Mode::gave_up, 0.6));
  CHECK_THAT(loop.step().why, Catch::Contains("in 5 s it came no nearer to waypoint 0"));
  loop.planner.set_course({{20, 25}});
  CHECK(loop.step().mode == Mode::drive);
}

TEST_CASE("Time without a map, or with a blind side, is no reason to give up") {
  Flat flat;
  flat.config.give_up_s = 5;
  Loop loop(flat.config, flat.map, {10, 25, 0});
  loop.planner.set_course({{40, 25}});
  loop.step();
  loop.senses.layers_age_s = 9;
  CHECK_FALSE(loop.until(Mode::gave_up, 20));
  loop.senses.layers_age_s = 0;
  loop.senses.blind_ahead = true;
  CHECK_FALSE(loop.until(Mode::gave_up, 20));
  loop.senses.blind_ahead = false;
  CHECK(loop.step().mode == Mode::drive);
}

TEST_CASE("A waypoint deep in an obstacle is none") {
  Flat flat;
  flat.map.obstacle(disc(40, 25, 6));
  flat.loop.planner.set_course({{40, 25}});
  check_stop(flat.loop.step(), Reason::goal_in_obstacle, "lies in an obstacle");
}

TEST_CASE("Boxed in beside a wall there is no way, and the waypoint is not to blame") {
  Flat flat;
  flat.map.obstacle([](double x, double y) { return x < 30 && !box(8.8, 24.8, 11.3, 26.2)(x, y); });
  Loop loop(flat.config, flat.map, {10, 25.2, 0});  // its side 0.1 m in a column, no more than that may err
  loop.planner.set_course({{40, 25}});
  check_stop(loop.step(), Reason::no_way, "no way to the waypoint");
}

TEST_CASE("It does not drive out of an obstacle that it stands in") {
  Flat flat;
  flat.map.obstacle(disc(10, 25, 2.0));
  flat.loop.planner.set_course({{40, 25}});
  check_stop(flat.loop.step(), Reason::stands_in_obstacle, "stands in an obstacle");
}

TEST_CASE("It leaves what it stands too near to") {
  Flat flat;
  // Its right side is at y 24.3; the margin of 0.2 m holds the middle at 24.2.
  flat.map.obstacle(box(9.0, 24.1, 11.2, 24.3));
  flat.loop.planner.set_course({{40, 25}});
  CHECK(flat.loop.until(Mode::arrived, 25));
}

TEST_CASE("At the last waypoint it stands within the tolerance and says so") {
  Flat flat;
  flat.loop.planner.set_course({{30, 25}});
  REQUIRE(flat.loop.until(Mode::arrived, 15));
  CHECK(std::hypot(flat.loop.vehicle.pose().x_m - 30, flat.loop.vehicle.pose().y_m - 25) < 1.0);
  CHECK(flat.loop.vehicle.speed_mps() < 0.1);
  CHECK_THAT(flat.loop.step().why, Catch::Contains("arrived"));
}

TEST_CASE("A waypoint that is passed by is left for the next one") {
  Flat flat;
  flat.loop.planner.set_course({{20, 25}, {40, 25}});
  planner::Course course(flat.config);
  course.set({{20, 25}, {40, 25}});
  course.update({10, 25});
  course.update({20.5, 29});  // 4.03 m beside it, beyond its plane
  CHECK(course.index() == 1);
  course.set({{20, 25}, {40, 25}});
  course.update({10, 25});
  course.update({19.5, 29});  // not beyond
  CHECK(course.index() == 0);
  course.update({20.5, 32});  // beyond, but 7 m beside
  CHECK(course.index() == 0);
  course.update({20, 26.4});  // within 1.5 m
  CHECK(course.index() == 1);
}

}  // namespace
}  // namespace gvom::test
