// What a cell costs, and which are known and lethal, in computed answers. Default weights and vehicle: half
// its width and the margin are 0.9 m.
#include <catch2/catch.hpp>
#include <cmath>

#include "services/planner/costmap.hpp"
#include "tests/planner/flat_map.hpp"

namespace gvom::test {
namespace {

using planner::Costmap;
using planner::CostmapConfig;
using planner::kLethalCost;
using planner::VehicleLimits;

constexpr int kEdge = 40;

Costmap costmap_of(const FlatMap& map) {
  Costmap costmap(CostmapConfig{}, VehicleLimits{}, map.n);
  costmap.update(map.view());
  return costmap;
}

float cost_at(const Costmap& costmap, int x, int y) {
  return costmap.cost()[y * costmap.cells().n + x];
}

TEST_CASE("Layers add to the cost of a metre by their weights") {
  FlatMap map(kEdge);
  const auto set = [&](int x, auto change) { change(map.at(x, 10)); };
  set(1, [&](int i) { map.slope[i] = 0.1F; });       // a quarter of 0.4 rad, of 4
  set(2, [&](int i) { map.slope[i] = 1.2F; });       // more than full
  set(3, [&](int i) { map.roughness[i] = 0.01F; });  // half of 0.02 m^2, of 6
  set(4, [&](int i) { map.visibility[i] = static_cast<std::uint8_t>(Visibility::remembered); });
  set(5, [&](int i) { map.slope[i] = map.roughness[i] = std::nanf(""); });
  set(6, [&](int i) {
    map.slope[i] = 0.2F;
    map.roughness[i] = 0.005F;
  });
  const Costmap costmap = costmap_of(map);
  const double expected[] = {1, 2, 5, 4, 2, 1, 1 + 2 + 1.5};
  for (int x = 0; x < 7; ++x) {
    INFO("column " << x);
    CHECK(cost_at(costmap, x, 10) == Approx(expected[x]));
  }
}

TEST_CASE("What is soft costs most below the middle, and nothing where the sides do not touch it") {
  FlatMap map(kEdge);
  map.flag(20, 20, 20, 20, kSoft);
  const Costmap costmap = costmap_of(map);
  CHECK(costmap.lethal()[map.at(20, 20)] == 0);
  CHECK(cost_at(costmap, 20, 20) == 17);
  CHECK(cost_at(costmap, 21, 20) == Approx(1 + 16 * 5.0 / 9));  // 0.4 m off, of 0.9 m
  CHECK(cost_at(costmap, 22, 20) == Approx(1 + 16 * 1.0 / 9));
  CHECK(cost_at(costmap, 20, 18) == Approx(1 + 16 * 1.0 / 9));
  CHECK(cost_at(costmap, 23, 20) == 1);  // 1.2 m
  CHECK(cost_at(costmap, 22, 22) == 1);  // 1.13 m
  map.flag(22, 20, 22, 20, kSoft);
  CHECK(cost_at(costmap_of(map), 21, 20) == Approx(1 + 16 * 5.0 / 9));  // two cost no more than one
}

TEST_CASE("Beside a trunk the cost falls from lethal to that of the ground") {
  FlatMap map(kEdge);
  map.flag(20, 20, 20, 20, kHard);
  const Costmap costmap = costmap_of(map);
  CHECK(cost_at(costmap, 20, 20) == kLethalCost);
  CHECK(cost_at(costmap, 22, 20) == kLethalCost);           // 0.8 m off: the vehicle hits it
  CHECK(cost_at(costmap, 23, 20) == Approx(1 + 10 * 0.7));  // 1.2 m: 0.3 m from the footprint
  CHECK(cost_at(costmap, 22, 22) == Approx(1 + 10 * (1 - (0.8 * std::sqrt(2) - 0.9))));
  CHECK(cost_at(costmap, 24, 20) == Approx(1 + 10 * 0.3));
  CHECK(cost_at(costmap, 25, 20) == 1);  // 2.0 m
  CHECK(costmap.distance_m()[map.at(23, 24)] == Approx(2.0F));
}

TEST_CASE("A single steep or negative column is noise, two or a single hard one are not") {
  for (const std::uint8_t bit : {kSteep, kNegative}) {
    FlatMap map(kEdge);
    map.flag(5, 5, 5, 5, bit);
    map.flag(20, 20, 20, 20, bit);
    map.flag(21, 21, 21, 21, bit);
    map.flag(5, 30, 5, 30, bit);
    map.flag(6, 30, 6, 30, kHard);
    map.flag(0, 0, 0, 0, bit);
    const Costmap costmap = costmap_of(map);
    CHECK(costmap.lethal()[map.at(5, 5)] == 0);
    CHECK(cost_at(costmap, 5, 5) == 17);  // as soft ground
    CHECK(costmap.lethal()[map.at(0, 0)] == 0);
    CHECK(costmap.lethal()[map.at(20, 20)] == 1);
    CHECK(costmap.lethal()[map.at(21, 21)] == 1);
    CHECK(costmap.lethal()[map.at(5, 30)] == 1);  // at the foot of a trunk
    CHECK(costmap.lethal()[map.at(6, 30)] == 1);
  }
}

TEST_CASE("What hangs lower than the vehicle and a decimetre is hit") {
  FlatMap map(kEdge);
  map.clearance[map.at(10, 10)] = 1.85F;
  map.clearance[map.at(30, 10)] = 1.95F;
  const Costmap costmap = costmap_of(map);
  CHECK(costmap.lethal()[map.at(10, 10)] == 1);
  CHECK(costmap.lethal()[map.at(30, 10)] == 0);
}

TEST_CASE("Rings of ground count as seen together where the gap between is short") {
  FlatMap map(kEdge);
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 3; x <= 5; ++x) map.forget(x, y);    // 1.2 m
    for (int x = 10; x <= 13; ++x) map.forget(x, y);  // 1.6 m
  }
  const Costmap costmap = costmap_of(map);
  for (int x = 3; x <= 5; ++x) {
    CHECK(costmap.known()[map.at(x, 20)] == 1);
    CHECK(cost_at(costmap, x, 20) == 1);
  }
  for (int x = 10; x <= 13; ++x) {
    CHECK(costmap.known()[map.at(x, 20)] == 0);
    CHECK(cost_at(costmap, x, 20) == 1.5);
  }
}

TEST_CASE("A gap is bridged along each of the four lines, on a diagonal by two columns at most") {
  const int ways[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
  for (const auto& [dx, dy] : ways) {
    for (int gap = 1; gap <= 4; ++gap) {
      INFO("way " << dx << " " << dy << ", gap " << gap);
      FlatMap map(kEdge);
      for (int y = 0; y < kEdge; ++y) {
        for (int x = 0; x < kEdge; ++x) map.forget(x, y);
      }
      for (const int k : {0, gap + 1}) {
        const int i = map.at(20 + k * dx, 20 + k * dy);
        map.height[i] = 0;
        map.visibility[i] = static_cast<std::uint8_t>(Visibility::ground_seen);
      }
      const Costmap costmap = costmap_of(map);
      const bool bridged = gap <= (dx * dy == 0 ? 3 : 2);
      for (int k = 1; k <= gap; ++k) CHECK(costmap.known()[map.at(20 + k * dx, 20 + k * dy)] == bridged);
      CHECK(costmap.known()[map.at(20 - dx, 20 - dy)] == 0);
    }
  }
}

TEST_CASE("No gap is bridged up more than the vehicle may lean") {
  FlatMap map(kEdge);
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) map.forget(x, y);
  }
  const auto bridge = [&](int y, float rise_m) {
    for (const int x : {10, 12})
      map.visibility[map.at(x, y)] = static_cast<std::uint8_t>(Visibility::ground_seen);
    map.height[map.at(10, y)] = 5;
    map.height[map.at(12, y)] = 5 + rise_m;
  };
  bridge(5, 0.33F);  // tan(0.4) over 0.8 m is 0.338 m
  bridge(15, 0.35F);
  bridge(25, -0.33F);
  bridge(35, -0.35F);
  const Costmap costmap = costmap_of(map);
  CHECK(costmap.known()[map.at(11, 5)] == 1);
  CHECK(costmap.known()[map.at(11, 15)] == 0);
  CHECK(costmap.known()[map.at(11, 25)] == 1);
  CHECK(costmap.known()[map.at(11, 35)] == 0);
}

TEST_CASE("No gap is bridged over a hole") {
  FlatMap map(kEdge);
  for (int y = 0; y < kEdge; ++y) {
    map.forget(20, y);
    map.forget(21, y);
    map.flags[map.at(20, y)] = kNegative;
  }
  const Costmap costmap = costmap_of(map);
  CHECK(costmap.known()[map.at(20, 20)] == 0);
  CHECK(costmap.known()[map.at(21, 20)] == 0);
  CHECK(costmap.lethal()[map.at(20, 20)] == 1);
}

TEST_CASE("Between middles the cost is bilinear, most beside what is lethal, and its gradient is the slope") {
  FlatMap map(kEdge);
  map.slope[map.at(10, 10)] = 0.4F;
  map.flag(30, 30, 30, 30, kHard);
  const Costmap costmap = costmap_of(map);
  const Eigen::Vector2d m = map.middle_m(10, 10);
  CHECK(costmap.smooth_cost(m.x(), m.y()) == Approx(5));
  CHECK(costmap.smooth_cost(m.x() + 0.1, m.y()) == Approx(4));
  CHECK(costmap.smooth_cost(m.x() + 0.2, m.y() - 0.2) == Approx(2));
  CHECK(costmap.sample(m.x() + 0.1, m.y() - 0.2).gradient.x() == Approx(-5));
  CHECK(costmap.sample(m.x() + 0.1, m.y() - 0.2).gradient.y() == Approx(7.5));
  const Eigen::Vector2d trunk = map.middle_m(30, 30);
  CHECK(costmap.smooth_cost(trunk.x(), trunk.y()) == Costmap::kMostCost);
  CHECK(costmap.smooth_cost(trunk.x() + 0.4, trunk.y()) == Approx(100 * (1 - 0.4 / 1.8)));
  CHECK(costmap.smooth_cost(-5, m.y()) == 1);
  CHECK(costmap.sample(-5, m.y()).gradient.x() == 0);
}

TEST_CASE("A map that is smaller than the largest is laid out by its own edge") {
  FlatMap map(16);
  map.flag(12, 3, 12, 3, kHard);
  Costmap costmap(CostmapConfig{}, VehicleLimits{}, 64);
  costmap.update(map.view());
  CHECK(costmap.lethal()[3 * 16 + 12] == 1);
  CHECK(costmap.distance_m()[3 * 16 + 2] == Approx(4.0F));
}

}  // namespace
}  // namespace gvom::test
