#include <catch2/catch.hpp>
#include <cmath>

#include "services/planner/optimiser.hpp"
#include "services/planner/search.hpp"
#include "tests/planner/flat_map.hpp"

namespace gvom::test {
namespace {

using planner::Costmap;
using planner::PathOptimiser;
using planner::PathPoint;
using planner::PlannerConfig;
using planner::Pose2;
using planner::Search;
using planner::SearchResult;

constexpr int kEdge = 96;

Costmap costmap_of(const FlatMap& map) {
  Costmap costmap(planner::CostmapConfig{}, planner::VehicleLimits{}, map.n);
  costmap.update(map.view());
  return costmap;
}

std::vector<Eigen::Vector2d> line(Eigen::Vector2d from, Eigen::Vector2d to) {
  std::vector<Eigen::Vector2d> points;
  const int pieces = static_cast<int>((to - from).norm() / 0.4);
  for (int i = 0; i <= pieces; ++i) points.emplace_back(from + (to - from) * i / pieces);
  return points;
}

// 1 m around (15, 20).
FlatMap map_with_pillar() {
  FlatMap map(kEdge);
  for (int i = 0; i < kEdge * kEdge; ++i) {
    if ((map.middle_m(i % kEdge, i / kEdge) - Eigen::Vector2d(15, 20)).norm() < 1) map.flags[i] = kHard;
  }
  return map;
}

// That it can be driven: each step from the one before by an arc, no curvature out of limits, none too quick.
void check_drivable(const std::vector<PathPoint>& path, double curvature_per_m, double speed_mps) {
  const planner::VehicleLimits limits;
  const double most_change = limits.max_curvature_rate_per_m_s * 0.5 / std::max(speed_mps, 1.0);
  double before = curvature_per_m;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double curvature = path[i].curvature_per_m;
    REQUIRE(std::fabs(curvature) <= limits.max_curvature_per_m + 1e-12);
    REQUIRE(std::fabs(curvature - before) <= most_change + 1e-12);
    REQUIRE(path[i + 1].pose.yaw_rad - path[i].pose.yaw_rad == Approx(curvature * 0.5).margin(1e-12));
    const Eigen::Vector2d moved = path[i + 1].pose.place() - path[i].pose.place();
    REQUIRE(moved.norm() == Approx(0.5));
    const double middle_rad = (path[i].pose.yaw_rad + path[i + 1].pose.yaw_rad) / 2;
    REQUIRE(moved.dot(Eigen::Vector2d(std::cos(middle_rad), std::sin(middle_rad))) == Approx(0.5));
    before = curvature;
  }
}

TEST_CASE("On open ground it goes straight on, as far as the horizon or the guide") {
  const FlatMap map(kEdge);
  const Costmap costmap = costmap_of(map);
  PathOptimiser optimiser{PlannerConfig{}};
  const auto& path = optimiser.optimise(costmap, {5, 20, 0}, 0, 4, line({5, 20}, {35, 20}));
  REQUIRE(path.size() == 41);
  CHECK(path.back().pose.x_m == Approx(25));
  CHECK(path.back().pose.y_m == Approx(20));
  CHECK(optimiser.cost() == Approx(20));
  CHECK(optimiser.optimise(costmap, {5, 20, 0}, 0, 4, line({5, 20}, {8.3, 20})).size() == 7);
  CHECK(optimiser.optimise(costmap, {5, 20, 0}, 0, 4, {{5, 20}}).size() == 1);
  CHECK(optimiser.optimise(costmap, {5, 20, 0}, 0, 4, {}).size() == 1);
}

TEST_CASE("It drives around a pillar in the guide's way and comes back") {
  const Costmap costmap = costmap_of(map_with_pillar());
  PathOptimiser optimiser{PlannerConfig{}};
  const auto& path = optimiser.optimise(costmap, {5, 20.3, 0}, 0, 3, line({5, 20.3}, {35, 20.3}));
  check_drivable(path, 0, 3);
  int hits = 0;
  double highest_m = 0;
  for (const PathPoint& point : path) {
    hits += !costmap.fits(point.pose);
    highest_m = std::max(highest_m, point.pose.y_m);
  }
  CHECK(hits == 0);
  CHECK(highest_m > 21.9);  // the pillar, half the vehicle and its margin
  CHECK(optimiser.begin_cost() > 200);
  CHECK(optimiser.cost() < 23);
  CHECK(std::fabs(path.back().pose.y_m - 20.3) < 1);
}

TEST_CASE("On random maps it is never dearer than its begin, and can always be driven") {
  PathOptimiser optimiser{PlannerConfig{}};
  int cheaper = 0, paths = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    const FlatMap map = random_map(random, kEdge, 0.002);
    const Costmap costmap = costmap_of(map);
    Search search(map.n);
    const Eigen::Vector2d from = map.middle_m(random.integer(30, 60), random.integer(30, 60));
    if (search.run(costmap, from, map.middle_m(random.integer(0, 90), random.integer(0, 90)), 0, 1 << 30) !=
        SearchResult::found)
      continue;
    const double speed_mps = random.uniform(0, 12), curvature_per_m = random.uniform(-0.5, 0.5);
    const Pose2 start{from.x(), from.y(), random.uniform(-3.1, 3.1)};
    const auto& path = optimiser.optimise(costmap, start, curvature_per_m, speed_mps, search.path());
    REQUIRE(path.front().pose.place() == from);
    check_drivable(path, curvature_per_m, speed_mps);
    REQUIRE(optimiser.cost() <= optimiser.begin_cost());
    cheaper += optimiser.cost() < 0.99 * optimiser.begin_cost();
    ++paths;
  }
  CHECK(paths > 20);
  CHECK(cheaper > paths / 2);
}

TEST_CASE("It goes on with the last cycle's path, where its start is on that") {
  const Costmap costmap = costmap_of(map_with_pillar());
  PathOptimiser optimiser{PlannerConfig{}};
  const auto guide = line({5, 20.3}, {35, 20.3});
  Pose2 start{5, 20.3, 0};
  double curvature_per_m = 0, first_cost = 0;
  for (int cycle = 0; cycle < 10; ++cycle) {
    INFO("cycle " << cycle);
    const auto& path = optimiser.optimise(costmap, start, curvature_per_m, 3, guide);
    check_drivable(path, curvature_per_m, 3);
    if (cycle == 0) first_cost = optimiser.cost();
    CHECK((cycle == 0 || optimiser.begin_cost() < first_cost + 1));  // along the guide it is over 200
    start = path[1].pose;
    curvature_per_m = path[0].curvature_per_m;
  }
  optimiser.optimise(costmap, {5, 20.3, 0}, 0, 3, guide);
  CHECK(optimiser.begin_cost() > 200);  // 5 m back: that path is of no use here
}

}  // namespace
}  // namespace gvom::test
