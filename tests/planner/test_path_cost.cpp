#include <catch2/catch.hpp>
#include <cmath>

#include "services/planner/path_cost.hpp"
#include "tests/planner/flat_map.hpp"

namespace gvom::test {
namespace {

using planner::Costmap;
using planner::CostmapConfig;
using planner::PathCost;
using planner::PathTask;
using planner::VehicleLimits;

constexpr double kStep_m = 0.5;

TEST_CASE("A path over level ground costs its length, its bends and how far its end is off") {
  FlatMap map(64);
  Costmap costmap(CostmapConfig{}, VehicleLimits{}, map.n);
  costmap.update(map.view());
  const std::vector<Eigen::Vector2d> tail{{10, 13}, {12, 13}};
  PathTask task{&costmap, {5, 12, 0}, 0.1, tail.data(), 2};
  PathCost cost(kStep_m, 40);
  const std::vector<double> straight(20, 0.0);
  // 10 m, a change by 0.1 and, past the tail's end, 1 m beside the line that goes on.
  CHECK(cost.evaluate(task, straight) == Approx(10 + 20 * 0.01 + 1));
  CHECK(cost.poses().back().x_m == Approx(15));
  task.curvature_per_m = 0.2;
  const std::vector<double> circle(20, 0.2);
  cost.evaluate(task, circle);
  CHECK(cost.poses().back().yaw_rad == Approx(2.0));
  // Each chord is as long as its step: they lie on a circle of radius step / (2 sin(turn / 2)).
  const double radius_m = kStep_m / (2 * std::sin(0.05));
  CHECK(cost.poses().back().x_m == Approx(5 + radius_m * std::sin(2.0)));
  CHECK(cost.poses().back().y_m == Approx(12 + radius_m * (1 - std::cos(2.0))));
}

TEST_CASE("The gradient is what finite differences say") {
  PathCost cost(kStep_m, 40);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    FlatMap map(64);
    for (auto& slope : map.slope) slope = static_cast<float>(random.uniform(0, 0.4));
    map.flag(30, 30, 30, 30, kHard);
    Costmap costmap(CostmapConfig{}, VehicleLimits{}, map.n);
    costmap.update(map.view());
    std::vector<Eigen::Vector2d> tail;
    for (int i = 0; i < 5; ++i) tail.emplace_back(10.0 + 2 * i, random.uniform(10, 14));
    const PathTask task{&costmap, {6, 12, random.uniform(-0.5, 0.5)}, 0.1, tail.data(), 5};
    std::vector<double> list(30), gradient;
    for (double& curvature : list) curvature = random.uniform(-0.3, 0.3);
    cost.evaluate(task, list);
    cost.gradient(task, list, gradient);
    int near = 0;
    for (int i = 0; i < 30; ++i) {
      constexpr double kLittle = 1e-7;
      std::vector<double> more = list, less = list;
      more[i] += kLittle;
      less[i] -= kLittle;
      const double expected = (cost.evaluate(task, more) - cost.evaluate(task, less)) / (2 * kLittle);
      near += std::fabs(gradient[i] - expected) < 1e-4 * (1 + std::fabs(expected));
    }
    INFO("seed " << seed);
    CHECK(near == 30);
  }
}

}  // namespace
}  // namespace gvom::test
