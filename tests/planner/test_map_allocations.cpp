// Costmap, search and optimiser allocate nothing after their first cycle.
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>

#include "services/planner/optimiser.hpp"
#include "services/planner/search.hpp"
#include "tests/planner/flat_map.hpp"

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
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  ++allocations;
  return __libc_realloc(memory, size);
}
}
#endif

namespace gvom::test {
namespace {

TEST_CASE("A hundred cycles after the first allocate nothing") {
  if (!kCountsMalloc) {
    WARN("SKIPPED: allocations are not counted under the address sanitizer");
    return;
  }
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
  const std::uint64_t before = allocations;
  for (int i = 1; i <= 100; ++i) cycle(i);
  const std::uint64_t after = allocations;
  CHECK(after - before == 0);
  CHECK(points > 1000);
}

}  // namespace
}  // namespace gvom::test
