// Who walks across the vehicle's way is not hit; what stands is no walker.
#include <catch2/catch.hpp>

#include "services/planner/movers.hpp"
#include "tests/planner_cycle/loop.hpp"

namespace gvom::test {
namespace {

using planner::Mode;
using planner::Movers;
using planner::Plan;

constexpr std::int64_t kCycle_ns = 100'000'000;
constexpr double kWalker_m = 0.3;  // half of his width

/// The cell that a walker is in and those that he touches are HARD, as he goes along y.
void place_walker(SmallMap& map, double x_m, double y_m) {
  std::fill(map.flags.begin(), map.flags.end(), std::uint8_t{0});
  const double reach_m = kWalker_m + SmallMap::kCell_m / 2;
  map.obstacle(box(x_m - reach_m, y_m - reach_m, x_m + reach_m, y_m + reach_m));
}

/// After a second of maps, each made by `shape(seconds)`.
template <class Shape>
bool sees_mover(Shape&& shape) {
  SmallMap map(64);
  Movers movers(64);
  for (int i = 0; i <= 10; ++i) {
    shape(map, 0.1 * i);
    movers.observe(map.view(i * kCycle_ns), {10, 12, 0}, 3);
  }
  return !movers.empty();
}

double to_outline_m(const SmallVehicle& vehicle, const Eigen::Vector2d& place_m) {
  double least_m = 1e9;
  for (int i = -20; i <= 20; ++i)
    for (const double side : {-1.0, 1.0})
      for (const Eigen::Vector2d& edge : {vehicle.outline(i / 20.0, side), vehicle.outline(side, i / 20.0)})
        least_m = std::min(least_m, (edge - place_m).norm());
  return least_m;
}

TEST_CASE("what walks is a mover, what stands or flickers is none") {
  CHECK(sees_mover([](SmallMap& map, double time_s) { place_walker(map, 15, 10 + 1.4 * time_s); }));
  CHECK_FALSE(sees_mover([](SmallMap& map, double) { place_walker(map, 15, 12); }));
  CHECK_FALSE(sees_mover([](SmallMap& map, double time_s) {
    place_walker(map, 15, 12 + (std::lround(10 * time_s) % 2 == 0 ? 0 : SmallMap::kCell_m));
  }));
  // A trunk that was hidden: there was no ground.
  CHECK_FALSE(sees_mover([](SmallMap& map, double time_s) {
    std::fill(map.flags.begin(), map.flags.end(), std::uint8_t{0});
    map.hide(disc(15, 12, 1));
    if (time_s > 0.8) map.obstacle(disc(15, 12, 0.3));
  }));
  CHECK_FALSE(sees_mover([](SmallMap& map, double time_s) { place_walker(map, 24, 10 + 1.4 * time_s); }));
}

TEST_CASE("the room that a mover can reach is closed, and opens again when he stands") {
  SmallMap map(64);
  Movers movers(64);
  int i = 0;
  for (; i <= 10; ++i) {
    place_walker(map, 15, 10 + 0.14 * i);
    movers.observe(map.view(i * kCycle_ns), {10, 12, 0}, 3);
  }
  const planner::MapView closed = movers.close(map.view());
  const planner::Cells cells = map.cells();
  // Five metres away at 3 m/s he walks 2.3 m.
  CHECK((closed.flags[cells.index_of(15, 13.2)] & kHard) != 0);
  CHECK((closed.flags[cells.index_of(15, 14.6)] & kHard) == 0);
  CHECK((map.flags[static_cast<std::size_t>(cells.index_of(15, 13.2))] & kHard) == 0);
  for (; i <= 30; ++i) movers.observe(map.view(i * kCycle_ns), {10, 12, 0}, 3);
  CHECK(movers.empty());
}

TEST_CASE("a walker who crosses is not hit, whenever he comes, and the vehicle goes on") {
  const planner::PlannerConfig config;
  for (double ahead_s = -1; ahead_s <= 1; ahead_s += 0.25) {
    SmallMap map(128);
    Loop loop(config, map, {5, 25, 0});
    loop.planner.set_course({{44, 25}});
    // At 4.5 m/s the vehicle is at x = 25 about then.
    const double begin_y_m = 25 - 1.4 * (6.2 + ahead_s);
    double nearest_m = 1e9, time_s = 0;
    const bool arrives = loop.until(Mode::arrived, 60, [&](const Plan&) {
      time_s += loop.period_s;
      const Eigen::Vector2d walker(25, begin_y_m + 1.4 * time_s);
      nearest_m = std::min(nearest_m, to_outline_m(loop.vehicle, walker));
      place_walker(map, walker.x(), walker.y());
    });
    CAPTURE(ahead_s, nearest_m, time_s);
    CHECK(arrives);
    CHECK(nearest_m > kWalker_m);
  }
}

}  // namespace
}  // namespace gvom::test
