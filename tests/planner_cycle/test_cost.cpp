// What a planning cycle costs: no memory after the first ones.
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/planner_cycle/loop.hpp"

namespace {
std::atomic<std::uint64_t> allocations{0};
}

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__ 1  // as g++ has it
#endif
#endif

#ifdef __SANITIZE_ADDRESS__
constexpr bool kCountsMalloc = false;  // the sanitizer's own malloc must stay
#else
constexpr bool kCountsMalloc = true;

// In place of the C library's, which operator new and Eigen call too.
extern "C" {
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
}
#endif

namespace gvom::test {
namespace {

TEST_CASE("After its first cycles the planner allocates nothing, whatever it does") {
  if (!kCountsMalloc) {
    WARN("SKIPPED: allocations are not counted under the address sanitizer");
    return;
  }
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
    const std::uint64_t before = allocations;
    const planner::Plan& plan = planner.cycle(&view, state, senses);
    if (cycles >= 5) allocated += allocations - before;
    mode = plan.mode;
    backs += mode == planner::Mode::back;
    vehicle.drive(plan.command, 0.1);
  }
  CHECK(allocated == 0);
  CHECK(backs > 0);
  CHECK(mode == planner::Mode::arrived);
}

TEST_CASE("The count of allocations counts") {
  if (!kCountsMalloc) return;
  const std::uint64_t before = allocations;
  const std::vector<int> some(1000);
  CHECK(allocations > before);
  CHECK(some.size() == 1000);
}

}  // namespace
}  // namespace gvom::test
