#include <catch2/catch.hpp>
#include <cmath>

#include "services/planner/distance.hpp"
#include "tests/core/random.hpp"
#include "tests/planner/slow_planning.hpp"

namespace gvom::test {
namespace {

using planner::DistanceTransform;

TEST_CASE("Distances to marked cells are those that trying all of them gives") {
  constexpr int kMost = 24;
  DistanceTransform transform(kMost);
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    const int n = random.integer(2, kMost);
    const double share = random.pick({0.003, 0.02, 0.2, 0.9});
    std::vector<std::uint8_t> marked(n * n);
    for (auto& cell : marked) cell = random.chance(share);
    std::vector<float> distance_m(n * n, -1);
    transform.run(marked.data(), n, 0.4, distance_m.data());
    const std::vector<double> expected = slow_distance(marked, n);
    for (int i = 0; i < n * n; ++i) {
      INFO("cell " << i);
      REQUIRE(distance_m[i] ==
              Approx(std::isinf(expected[i]) ? DistanceTransform::kFar_m : 0.4 * expected[i]).epsilon(1e-6));
    }
  }
}

TEST_CASE("From one marked cell it is three and four cells to five") {
  DistanceTransform transform(8);
  std::vector<std::uint8_t> marked(64);
  marked[8 * 2 + 1] = 1;
  std::vector<float> distance_m(64);
  transform.run(marked.data(), 8, 0.5, distance_m.data());
  CHECK(distance_m[8 * 2 + 1] == 0);
  CHECK(distance_m[8 * 2 + 7] == 3.0F);
  CHECK(distance_m[8 * 6 + 4] == 2.5F);
}

}  // namespace
}  // namespace gvom::test
