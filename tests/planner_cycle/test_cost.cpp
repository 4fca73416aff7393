// What a planning cycle costs: no memory after the first ones.
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

}  // namespace
}  // namespace gvom::test
