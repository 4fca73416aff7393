// The truth planner on maps that are drawn by hand, and against relaxing all columns until nothing changes.
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/drive/driven.hpp"
#include "tools/drive/true_obstacles.hpp"
#include "tools/drive/truth_planner.hpp"
#include "tools/sim/noise.hpp"

using namespace gvom;
using namespace gvom::driving;
using namespace gvom::test;

namespace {

/// '#' cannot be driven on. The first line is the farthest in y; column (0, 0) begins at the origin.
sim::GroundTruth drawn(const std::vector<std::string>& lines, double resolution_m) {
  sim::GroundTruth truth{};
  truth.resolution_m = resolution_m;
  truth.size_x = static_cast<int>(lines.front().size());
  truth.size_y = static_cast<int>(lines.size());
  for (auto line = lines.rbegin(); line != lines.rend(); ++line)
    for (const char mark : *line) truth.drivable.push_back(mark == '#' ? 0 : 1);
  truth.ground_mean.assign(truth.drivable.size(), 0.0F);
  return truth;
}

/// Seconds from one column to the other, relaxed until nothing changes; every column on its own.
double relaxed_seconds(const sim::GroundTruth& truth, int from, int to, double speed_mps) {
  std::vector<double> seconds(truth.drivable.size(), HUGE_VAL);
  seconds[from] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (int a = 0; a < truth.size_x * truth.size_y; ++a)
      for (int b = 0; b < truth.size_x * truth.size_y; ++b) {
        const int dx = std::abs(a % truth.size_x - b % truth.size_x),
                  dy = std::abs(a / truth.size_x - b / truth.size_x);
        if (truth.drivable[a] == 0 || truth.drivable[b] == 0 || std::max(dx, dy) != 1) continue;
        const double there = seconds[a] + truth.resolution_m * std::sqrt(dx + dy) / speed_mps;
        if (there < seconds[b] - 1e-9) {
          seconds[b] = there;
          changed = true;
        }
      }
  }
  return seconds[to];
}

Eigen::Vector2d middle(int x, int y, double resolution_m) {
  return {(x + 0.5) * resolution_m, (y + 0.5) * resolution_m};
}

}  // namespace

TEST_CASE("it goes through the gap that is wide enough for the vehicle, at its speed") {
  const std::vector<std::string> lines{
      "...........#...........",  //
      "...........#...........",  //
      "...........#...........",  //
      "...........#...........",  //
      "...........#...........",  //
      ".......................",  // y = 7: 1 column
      "...........#...........",  //
      "...........#...........",  //
      ".......................",  //
      ".......................",  //
      ".......................",  // y = 2: the middle of 5 columns
      ".......................",  //
      ".......................",  //
  };
  const sim::GroundTruth truth = drawn(lines, 0.5);
  const Eigen::Vector2d start = middle(2, 7, 0.5), goal = middle(20, 7, 0.5);
  const auto narrow = TruthPlanner(truth, {0.9, 3, 0.1}).plan(start, {goal});
  REQUIRE(narrow);
  CHECK(narrow->length_m == Approx(9));
  CHECK(narrow->seconds == Approx(3));
  // 2 m wide: a column beyond `drivable` is kept free, so it passes the wall at y = 3 or lower: 4 columns
  // aside.
  const auto wide = TruthPlanner(truth, {2, 3, 0.1}).plan(start, {goal});
  REQUIRE(wide);
  CHECK(wide->length_m == Approx(0.5 * (8 * std::sqrt(2.0) + 10)).margin(1e-6));
  CHECK_FALSE(TruthPlanner(truth, {7, 3, 0.1}).plan(start, {goal}));
}

TEST_CASE("waypoints are reached in turn, within the tolerance") {
  const sim::GroundTruth truth = drawn(std::vector<std::string>(21, std::string(41, '.')), 0.5);
  const TruthPlanner planner(truth, {0.5, 2, 1.6});
  const auto way = planner.plan(middle(2, 2, 0.5), {middle(22, 2, 0.5), middle(2, 2, 0.5)});
  REQUIRE(way);
  // 1.5 m before the first waypoint, and as much before the start.
  CHECK(way->length_m == Approx(2 * 10 - 3 * 1.5));
  CHECK(way->seconds == Approx(way->length_m / 2));
}

TEST_CASE("steep ground is driven on at half the speed") {
  sim::GroundTruth truth = drawn(std::vector<std::string>(9, std::string(41, '.')), 0.5);
  for (int i = 0; i < 9 * 41; ++i)
    truth.ground_mean[i] = static_cast<float>(std::tan(0.24) * 0.5 * (i % 41));  // half of the steepest
  const auto way = TruthPlanner(truth, {0.5, 2, 0.1}).plan(middle(2, 4, 0.5), {middle(32, 4, 0.5)});
  REQUIRE(way);
  CHECK(way->seconds == Approx(15 / (2 * 0.75)).epsilon(1e-3));
}

TEST_CASE("it finds the fastest way of random maps") {
  sim::Random random(5);
  int ways = 0, none = 0;
  for (int map = 0; map < 60; ++map) {
    std::vector<std::string> lines(12, std::string(12, '.'));
    for (std::string& line : lines)
      for (char& mark : line)
        if (random.between(0, 1) < 0.38) mark = '#';
    lines[11][0] = lines[0][11] = '.';
    const sim::GroundTruth truth = drawn(lines, 1.0);
    const auto way = TruthPlanner(truth, {1.0, 3, 0.1}).plan(middle(0, 0, 1), {middle(11, 11, 1)});
    const double expected = relaxed_seconds(truth, 0, 12 * 12 - 1, 3);
    REQUIRE(way.has_value() == std::isfinite(expected));
    if (way) CHECK(way->seconds == Approx(expected).epsilon(1e-5));
    ++(way ? ways : none);
  }
  CHECK(ways > 10);
  CHECK(none > 10);
}

TEST_CASE("obstacles have edges where they border on what is none, walkers a circle where they are") {
  sim::WorldData data = level_world();
  add(data, sim::Kind::walker, post(0, 0, 0.25, 1.8));
  data.objects.back().track = {{0, -20, 0}, {10, -3, 0}};
  const sim::World world(std::move(data));
  sim::GroundTruth truth = drawn({"....", ".##.", ".#..", "...#"}, 1.0);
  for (const std::uint8_t drivable : truth.drivable) truth.lethal.push_back(drivable == 0 ? 1 : 0);
  truth.classes.assign(truth.drivable.size(), 0);
  const TrueObstacles obstacles(world, truth);
  const std::vector<Edge> edges = obstacles.edges();
  CHECK(edges.size() == 8 + 4);  // an L of three columns, and one at the map's corner
  for (const auto& [from, to] : edges) CHECK((to - from).norm() == Approx(1));
  const std::vector<Edge> circle = obstacles.walker_edges(10);
  REQUIRE(circle.size() >= 8);
  for (const auto& [from, to] : circle) {
    CHECK((from - Eigen::Vector2d(-3, 0)).norm() == Approx(0.25).margin(1e-6));
    CHECK((to - from).norm() < 0.25);
  }
}

TEST_CASE("distances are from the vehicle's outline to what is lethal, to half a column") {
  sim::WorldData data = level_world();
  add(data, sim::Kind::tree, post(5, 0, 0.2, 4));
  add(data, sim::Kind::rock, ball({0, 3, 0}, 0.4), 0.4);
  add(data, sim::Kind::bush, ball({0, -2, 0.5}, 0.5), 1.0, 0.1);
  add(data, sim::Kind::walker, post(0, 0, 0.25, 1.8));
  data.objects.back().track = {{0, -20, 0}, {10, -3, 0}};
  const sim::World world(std::move(data));
  const TrueObstacles obstacles(world, sim::sample_truth(world, {0.2}));
  const planner::VehicleLimits vehicle = small_vehicle().limits;
  CHECK(obstacles.nearest_m(vehicle, {0, 0, 0}, 0) == Approx(3 - 0.4 - 0.7).margin(0.2));
  CHECK(obstacles.nearest_m(vehicle, {1, -6, M_PI / 2}, 0) ==
        Approx(std::hypot(4 - 0.7, 6 - 0.8) - 0.2).margin(0.2));
  CHECK(obstacles.nearest_m(vehicle, {0, -1, 0}, 10) ==
        Approx(std::hypot(3 - 0.8, 1 - 0.7) - 0.25).margin(1e-6));
  CHECK(obstacles.nearest_m(vehicle, {4.5, 0, 0}, 0) == 0);
  CHECK(obstacles.nearest_m(vehicle, {40, 0, 0}, 0) == TrueObstacles::kReach_m);
}
