// Costmap, search and optimiser allocate nothing after their first cycle.
#include <catch2/catch.hpp>

#include "services/planner/optimiser.hpp"
#include "services/planner/search.hpp"
#include "tests/planner/flat_map.hpp"
#include "tests/support/allocations.hpp"

namespace gvom::test {
namespace {

TEST_CASE("A hundred cycles after the first allocate nothing") {
  if (!counts_allocations()) return;
  constexpr int kEdge = 96;
  const planner::PlannerConfig config;
  Random random(1);
  std::vector<FlatMap> maps;
  for (int i = 0; i < 10; ++i) maps.push_back(random_map(random, kEdge, 0.002));
  planner::Costmap costmap(config.costmap, config.vehicle, kEdge);
  planner::Search search(kEdge);
  planner::PathOptimiser optimiser(config);
  std::size_t points = 0;
  const auto cycle = [&](int i) {
    costmap.update(maps[i % 10].view());
    const Eigen::Vector2d goal = i % 3 == 0 ? Eigen::Vector2d(300, 4.0 * i) : Eigen::Vector2d(4, 0.3 * i);
    search.run(costmap, {19, 19}, goal, 8, 1 << 30);
    points += optimiser.optimise(costmap, {19, 19, 0.1 * i}, 0, 4, search.path()).size();
  };
  cycle(0);
  const std::uint64_t before = allocations();
  for (int i = 1; i <= 100; ++i) cycle(i);
  const std::uint64_t after = allocations();
  CHECK(after - before == 0);
  CHECK(points > 1000);
}

}  // namespace
}  // namespace gvom::test
