#include <catch2/catch.hpp>
#include <cmath>

#include "services/planner/search.hpp"
#include "tests/planner/flat_map.hpp"
#include "tests/planner/slow_planning.hpp"

namespace gvom::test {
namespace {

using planner::Costmap;
using planner::CostmapConfig;
using planner::Search;
using planner::SearchResult;
using planner::VehicleLimits;

constexpr int kNoBudget = 1 << 30;
constexpr double kEverywhere_m = 1000;

// A vehicle that is narrower than a cell: what is lethal is no way, and nothing grows.
struct Ways {
  FlatMap map;
  Costmap costmap;
  Search search;

  static CostmapConfig plain() {
    CostmapConfig config;
    config.margin_m = 0;
    config.near_weight = 0;
    return config;
  }
  static VehicleLimits thin() {
    VehicleLimits vehicle;
    vehicle.width_m = vehicle.front_m = vehicle.rear_m = 0.1;
    return vehicle;
  }

  explicit Ways(FlatMap layers, const CostmapConfig& config = plain(), const VehicleLimits& vehicle = thin())
      : map(std::move(layers)), costmap(config, vehicle, map.n), search(map.n) {
    costmap.update(map.view());
  }

  SearchResult run(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double around_m = 0,
                   int budget = kNoBudget) {
    return search.run(costmap, from, to, around_m, budget);
  }
  [[nodiscard]] float to_go(int x, int y) const { return search.cost_to_go()[map.at(x, y)]; }
  [[nodiscard]] std::vector<double> costs() const { return {costmap.cost(), costmap.cost() + map.n * map.n}; }
};

double cost_along(const Ways& ways, const std::vector<Eigen::Vector2d>& path) {
  double total = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const auto cost = [&](std::size_t k) {
      return double{ways.costmap.cost()[ways.costmap.cells().index_of(path[k].x(), path[k].y())]};
    };
    total += (path[i] - path[i - 1]).norm() * (cost(i) + cost(i - 1)) / 2;
  }
  return total;
}

TEST_CASE("Over open ground it goes straight, and what is left to pay is the length") {
  Ways ways{FlatMap(32)};
  REQUIRE(ways.run(ways.map.middle_m(4, 6), ways.map.middle_m(14, 10)) == SearchResult::found);
  CHECK(ways.to_go(4, 6) == Approx(0.4 * (6 + 4 * std::sqrt(2))));
  CHECK(ways.to_go(14, 10) == 0);
  REQUIRE(ways.search.path().size() == 11);
  CHECK(ways.search.path().front() == ways.map.middle_m(4, 6));
  CHECK(ways.search.path().back() == ways.map.middle_m(14, 10));
}

TEST_CASE("What is left to pay is what a slow Dijkstra finds, wherever it was asked for") {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    Ways ways{random_map(random, 48, random.pick({0.0, 0.1, 0.3}))};
    const int from = random.integer(0, 48 * 48 - 1), to = random.integer(0, 48 * 48 - 1);
    std::vector<double> costs = ways.costs();
    if (std::isinf(costs[to])) continue;
    if (std::isinf(costs[from])) costs[from] = Costmap::kMostCost;
    const std::vector<double> expected = slow_cost_to_go(costs, 48, 0.4, {{to, 0}});
    const double around_m = random.pick({0.0, 3.0, kEverywhere_m});
    const auto result =
        ways.run(ways.map.middle_m(from % 48, from / 48), ways.map.middle_m(to % 48, to / 48), around_m);
    REQUIRE((result == SearchResult::found) == !std::isinf(expected[from]));
    if (result != SearchResult::found) continue;
    ++found;
    CHECK(ways.search.cost_to_go()[from] == Approx(expected[from]).epsilon(1e-5));
    if (!std::isinf(ways.costs()[from]))
      CHECK(cost_along(ways, ways.search.path()) == Approx(expected[from]).epsilon(1e-5));
    if (around_m < kEverywhere_m) continue;
    for (int i = 0; i < 48 * 48; ++i) {
      if (!std::isinf(expected[i])) REQUIRE(ways.search.cost_to_go()[i] == Approx(expected[i]).epsilon(1e-5));
    }
  }
  CHECK(found > 20);
}

TEST_CASE("All around the vehicle is searched to the end, the far side of the map is not") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    Ways ways{random_map(random, 64, 0.02)};
    const int from = ways.map.at(20, 32), to = ways.map.at(40, 32);
    std::vector<double> costs = ways.costs();
    if (std::isinf(costs[to]) || std::isinf(costs[from])) continue;
    REQUIRE(ways.run(ways.map.middle_m(20, 32), ways.map.middle_m(40, 32), 4) == SearchResult::found);
    const std::vector<double> expected = slow_cost_to_go(costs, 64, 0.4, {{to, 0}});
    // What is connected to the vehicle within 4 m: of open ground, nearly all of it.
    for (int i = 0; i < 64 * 64; ++i) {
      const double off_m = 0.4 * std::hypot(i % 64 - 20, i / 64 - 32);
      if (off_m <= 3 && !std::isinf(expected[i]))
        REQUIRE(ways.search.cost_to_go()[i] == Approx(expected[i]).epsilon(1e-5));
    }
  }
}

TEST_CASE("It does not squeeze through between two obstacles that touch at a corner") {
  FlatMap map(24);
  map.flag(12, 0, 12, 11, kHard);
  map.flag(11, 12, 11, 23, kHard);  // (12, 11) and (11, 12) touch at a corner
  Ways ways{map};
  CHECK(ways.run(map.middle_m(4, 12), map.middle_m(20, 12)) == SearchResult::no_way);
  CHECK(ways.search.path().empty());
  map.flags[map.at(11, 12)] = 0;
  Ways open{map};
  CHECK(open.run(map.middle_m(4, 12), map.middle_m(20, 12)) == SearchResult::found);
}

TEST_CASE("A goal beyond the map is reached over the border's cell that is best with what is left beyond") {
  FlatMap map(32);
  map.flag(31, 0, 31, 20, kHard);  // the border towards the goal is open from y = 21 on
  map.flag(0, 0, 30, 0, kHard);
  Ways ways{map};
  const Eigen::Vector2d goal = map.middle_m(131, 10);
  REQUIRE(ways.run(map.middle_m(10, 10), goal) == SearchResult::found);
  std::vector<SlowSeed> seeds;
  for (int i = 0; i < 32 * 32; ++i) {
    const int x = i % 32, y = i / 32;
    if (x > 0 && y > 0 && x < 31 && y < 31) continue;
    if (!std::isinf(ways.costs()[i])) seeds.push_back({i, 1.3 * 0.4 * std::hypot(131 - x, 10 - y)});
  }
  const std::vector<double> expected = slow_cost_to_go(ways.costs(), 32, 0.4, seeds);
  CHECK(ways.to_go(10, 10) == Approx(expected[map.at(10, 10)]).epsilon(1e-5));
  const Eigen::Vector2d end = ways.search.path().back();
  CHECK(ways.costmap.cells().index_of(end.x(), end.y()) == map.at(31, 21));
}

TEST_CASE("Where the map is walled in, a goal beyond it has no way") {
  FlatMap map(32);
  map.flag(5, 5, 25, 5, kHard);
  map.flag(5, 25, 25, 25, kHard);
  map.flag(5, 5, 5, 25, kHard);
  map.flag(25, 5, 25, 25, kHard);
  Ways ways{map};
  CHECK(ways.run(map.middle_m(15, 15), {100, 100}) == SearchResult::no_way);
  CHECK(std::isinf(ways.to_go(15, 15)));
  CHECK(ways.to_go(28, 15) > 0);
}

TEST_CASE("A goal in an obstacle is reached beside it, but not farther off than three metres") {
  FlatMap map(48);
  map.flag(20, 20, 26, 30, kHard);
  Ways ways{map};
  REQUIRE(ways.run(map.middle_m(4, 25), map.middle_m(22, 25)) == SearchResult::found);
  CHECK(ways.search.path().back() == map.middle_m(19, 25));
  FlatMap large(48);
  large.flag(10, 10, 30, 30, kHard);
  Ways inside{large};
  CHECK(inside.run(map.middle_m(4, 25), map.middle_m(20, 20)) == SearchResult::goal_in_obstacle);
}

TEST_CASE("A vehicle that stands too near to something leaves, one that is shut in does not") {
  FlatMap map(48);
  map.flag(21, 20, 21, 20, kHard);  // 0.4 m beside base_link; all within 0.9 m is no way
  Ways ways{map, CostmapConfig{}, VehicleLimits{}};
  REQUIRE(ways.costmap.cost()[map.at(20, 20)] == planner::kLethalCost);
  CHECK(ways.run(map.middle_m(20, 20), map.middle_m(4, 20)) == SearchResult::found);
  CHECK(ways.to_go(20, 20) > 0.4 * 16);
  map.flag(10, 10, 30, 30, kHard);
  Ways shut{map, CostmapConfig{}, VehicleLimits{}};
  CHECK(shut.run(map.middle_m(20, 20), map.middle_m(4, 20)) == SearchResult::vehicle_in_obstacle);
  CHECK(shut.run({-3, 4}, map.middle_m(4, 20)) == SearchResult::no_way);
}

TEST_CASE("A budget that is spent gives the way to what came nearest") {
  Ways ways{FlatMap(64)};
  const auto from = ways.map.middle_m(2, 32), to = ways.map.middle_m(60, 32);
  REQUIRE(ways.run(from, to, 0, 40) == SearchResult::cut);
  const auto& path = ways.search.path();
  REQUIRE(path.size() > 2);
  CHECK(path.front() == from);
  CHECK(path.back() == to);
  CHECK((path[1] - from).norm() < (to - from).norm() - 5);
  CHECK(ways.run(from, to, 0, 0) == SearchResult::cut);
  CHECK(ways.search.path().size() == 2);
  CHECK(ways.run(from, to) == SearchResult::found);
}

TEST_CASE("The same map gives the same way, whatever was searched before") {
  Random random(3);
  Ways ways{random_map(random, 48, 0.05)};
  const auto from = ways.map.middle_m(3, 3), to = ways.map.middle_m(44, 40);
  REQUIRE(ways.run(from, to) == SearchResult::found);
  const std::vector<Eigen::Vector2d> first = ways.search.path();
  ways.run(to, from, kEverywhere_m);
  ways.run(from, to);
  CHECK(ways.search.path() == first);
}

}  // namespace
}  // namespace gvom::test
