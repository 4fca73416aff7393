// What a planning cycle costs: no memory after the first ones.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/planner_cycle/loop.hpp"
#include "tests/support/allocations.hpp"

namespace gvom::test {
namespace {

TEST_CASE("After its first cycles the planner allocates nothing, whatever it does") {
  if (!counts_allocations()) return;
  planner::PlannerConfig config;
  config.costmap.near_weight = 1;
  SmallMap map(128);
  map.obstacle(box(12, 26.4, 12.8, 52));
  map.obstacle(box(12, 6, 12.8, 23.6));
  map.obstacle(box(12, 26.4, 30, 27.2));
  map.obstacle(box(12, 22.8, 30, 23.6));
  SmallVehicle vehicle(config.vehicle, {5, 25, 0});
  planner::Planner planner(config, map.cells().n);
  planner.set_course({{42, 25}, {42, 40}});
  std::uint64_t allocated = 0;
  int cycles = 0, backs = 0;
  planner::Mode mode = planner::Mode::stop;
  for (; cycles < 900 && mode != planner::Mode::arrived; ++cycles) {
    if (vehicle.pose().x_m > 21) map.obstacle(box(29.2, 22.8, 30, 27.2));
    const planner::State state = vehicle.state();
    const planner::MapView view = map.view(state.stamp_ns);
    planner::Senses senses;
    senses.layers_age_s = cycles % 50 == 49 ? 1 : 0;
    const std::uint64_t before = allocations();
    const planner::Plan& plan = planner.cycle(&view, state, senses);
    if (cycles >= 5) allocated += allocations() - before;
    mode = plan.mode;
    backs += mode == planner::Mode::back;
    vehicle.drive(plan.command, 0.1);
  }
  CHECK(allocated == 0);
  CHECK(backs > 0);
  CHECK(mode == planner::Mode::arrived);
}

TEST_CASE("nor where tufts flicker all around and somebody walks into its way") {
  if (!counts_allocations()) return;
  const planner::PlannerConfig config;
  SmallMap map(128);
  SmallVehicle vehicle(config.vehicle, {5, 25, 0});
  planner::Planner planner(config, map.cells().n);
  planner.set_course({{45, 25}});
  std::uint64_t allocated = 0;
  int waits = 0;
  planner::Mode mode = planner::Mode::stop;
  for (int cycle = 0; cycle < 600 && mode != planner::Mode::arrived; ++cycle) {
    for (std::size_t i = 0; i < map.flags.size(); ++i)
      map.flags[i] = i * 7919 % 97 == 0 && (i + static_cast<std::size_t>(cycle)) % 5 < 3 ? kSoft : 0;
    map.where(box(5, 22, 45, 28), [&](std::size_t i) { map.flags[i] = 0; });
    map.obstacle(box(5, 21.2, 45, 22));
    map.obstacle(box(5, 28, 45, 28.8));
    map.obstacle(disc(25, 25 + 2.0 * std::sin(0.07 * cycle), 0.5));  // to and fro across the lane
    const planner::State state = vehicle.state();
    const planner::MapView view = map.view(state.stamp_ns);
    const std::uint64_t before = allocations();
    const planner::Plan& plan = planner.cycle(&view, state, {});
    if (cycle >= 5) allocated += allocations() - before;
    waits += plan.reason == planner::Reason::mover;
    mode = plan.mode;
    vehicle.drive(plan.command, 0.1);
  }
  CHECK(allocated == 0);
  CHECK(waits > 0);
  CHECK(mode == planner::Mode::arrived);
}

}  // namespace
}  // namespace gvom::test
