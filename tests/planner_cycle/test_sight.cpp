// It never gets over ground that was not known, and it looks for what it does not know.
#include <catch2/catch.hpp>

#include "tests/core/random.hpp"
#include "tests/planner_cycle/loop.hpp"

namespace gvom::test {
namespace {

using Eigen::Vector2d;
using planner::Mode;
using planner::Plan;
using planner::PlannerConfig;
using planner::Reason;

// Whether the height under every place of the vehicle's outline is known, by the map alone.
bool stands_on_known(const SmallMap& map, const SmallVehicle& vehicle) {
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j) {
      const Vector2d place = vehicle.outline(i / 4.0, j / 4.0);
      const int index = map.cells().index_of(place.x(), place.y());
      if (index < 0 || std::isnan(map.height[static_cast<std::size_t>(index)])) return false;
    }
  return true;
}

TEST_CASE("On random maps with holes of unknown ground the vehicle never gets over one") {
  std::int64_t cycles = 0;
  double fastest_mps = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    PlannerConfig config;
    config.costmap.gap_m = 0;  // nothing that is unknown counts as known
    config.vehicle.latency_s = random.pick({0.1, 0.3, 0.5});
    config.speed_mps = config.vehicle.max_speed_mps = random.uniform(2, 12);
    SmallMap map(128);
    for (int i = 0; i < 25; ++i) {
      const double x = random.uniform(8, 50), y = random.uniform(0, 50), radius = random.uniform(0.5, 3);
      if (std::hypot(x - 5, y - 25) > radius + 3) map.hide(disc(x, y, radius));
    }
    map.hide(box(0, 0, 52, 0.8));
    Loop loop(config, map, {5, 25, random.uniform(-1, 1)});
    loop.planner.set_course({{random.uniform(20, 45), random.uniform(5, 45)}, {45, 25}});
    loop.until(Mode::arrived, 20, [&](const Plan& plan) {
      CAPTURE(seed, loop.vehicle.pose().x_m, loop.vehicle.pose().y_m, loop.vehicle.speed_mps(), plan.why);
      REQUIRE(stands_on_known(map, loop.vehicle));
      fastest_mps = std::max(fastest_mps, loop.vehicle.speed_mps());
      ++cycles;
    });
  }
  CHECK(cycles > 1500);
  CHECK(fastest_mps > 4);  // it does drive
}

TEST_CASE("It stops before the ground ends, however fast it was asked to drive") {
  for (const double speed_mps : {1.0, 4.5, 12.0}) {
    PlannerConfig config;
    config.speed_mps = config.vehicle.max_speed_mps = speed_mps;
    SmallMap map(128);
    map.hide(box(40, 0, 52, 52));
    Loop loop(config, map, {4, 25, 0});
    loop.planner.set_course({{48, 25}});
    double farthest_m = 0, slowest_creep_mps = 9;
    bool creeps = false;
    loop.until(Mode::gave_up, 50, [&](const Plan& plan) {
      farthest_m = std::max(farthest_m, loop.vehicle.outline(1, 0).x());
      if (plan.mode == Mode::creep) creeps = true;
      if (plan.mode == Mode::creep) slowest_creep_mps = std::min(slowest_creep_mps, plan.command.speed_mps);
    });
    CAPTURE(speed_mps, slowest_creep_mps);
    // A metre before it, and what a grid of 0.4 m and steps of 0.25 m take.
    CHECK(farthest_m < 40);
    CHECK(farthest_m > 38);
    CHECK(creeps);
  }
}

TEST_CASE("Where the ground shows as it comes nearer it creeps up and goes on") {
  PlannerConfig config;
  SmallMap map(128);
  const SmallMap whole(128);
  map.hide(box(22, 0, 52, 52));  // behind a crest at x = 22
  Loop loop(config, map, {4, 25, 0});
  loop.planner.set_course({{44, 25}});
  double slowest_mps = 9;
  bool shown = false;
  const bool arrives = loop.until(Mode::arrived, 60, [&](const Plan&) {
    const double front_m = loop.vehicle.outline(1, 0).x();
    if (front_m > 19) slowest_mps = std::min(slowest_mps, shown ? 9.0 : loop.vehicle.speed_mps());
    if (front_m < 20.5 || shown) return;
    shown = true;  // a metre and a half before the crest it sees over it
    map.height = whole.height;
    map.visibility = whole.visibility;
    map.slope = whole.slope;
    map.roughness = whole.roughness;
  });
  CHECK(shown);
  CHECK(arrives);
  CHECK(slowest_mps < 2.0);
}

TEST_CASE("Ground that does not show within five seconds is left for another way") {
  // A wall with two gates; the ground in the near one is never seen.
  SmallMap map(128);
  map.obstacle(
      [](double x, double y) { return x > 24 && x < 25.2 && !(y > 22 && y < 28) && !(y > 40 && y < 46); });
  map.hide(box(23.6, 21, 26.4, 29));
  PlannerConfig config;
  config.costmap.unknown_cost = 0.5;
  Loop loop(config, map, {10, 25, 0});
  loop.planner.set_course({{40, 25}});
  bool waited = false, touched = false;
  const bool arrives = loop.until(Mode::arrived, 60, [&](const Plan& plan) {
    waited = waited || (plan.mode == Mode::stop && plan.reason == Reason::unseen_ground);
    touched = touched || !stands_on_known(map, loop.vehicle);
  });
  CHECK(waited);
  CHECK_FALSE(touched);
  CHECK(arrives);
}

}  // namespace
}  // namespace gvom::test
