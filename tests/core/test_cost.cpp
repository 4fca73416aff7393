// One byte of cost (R16), computed by hand.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/column.hpp"
#include "tests/core/rig.hpp"

namespace gvom::test {
namespace {

const CostConfig kDefault;

int cost(float density, float slope, float roughness, const CostConfig& config = kDefault,
         std::uint8_t flags = 0) {
  return column_cost(config, flags, 0.05f, density, slope, roughness);
}

TEST_CASE("Cost is the mean of the three shares, of 252, rounded down") {
  CHECK(cost(0, 0, 0) == 0);
  CHECK(cost(0.375f, 0, 0) == 31);      // 252 * 0.375 / 3 = 31.5
  CHECK(cost(0, 0.25f, 0) == 42);       // 252 * (0.25 / 0.5) / 3
  CHECK(cost(0, 0, 0.025f) == 42);      // 252 * (0.025 / 0.05) / 3
  CHECK(cost(0, 0.125f, 0) == 21);      // 252 * 0.25 / 3
  CHECK(cost(0.25f, 0.125f, 0) == 42);  // 252 * (0.25 + 0.25) / 3
}

TEST_CASE("A share is full at its full-scale value and no more beyond") {
  CHECK(cost(0, 0.5f, 0) == 84);
  CHECK(cost(0, 1.5f, 0) == 84);
  CHECK(cost(0, 0, 10.0f) == 84);
  CHECK(cost(1, 1.5f, 10.0f) == 252);
}

TEST_CASE("Weights count in relation to each other") {
  CHECK(cost(0.375f, 0, 0, {2, 1, 1, 0.5, 0.05}) == 47);  // 252 * 2 * 0.375 / 4 = 47.25
  CHECK(cost(0.375f, 0.5f, 0, {0, 3, 1, 0.5, 0.05}) == 189);
  CHECK(cost(0.375f, 0.5f, 1, {1, 0, 0, 0.5, 0.05}) == 94);  // 252 * 0.375 = 94.5
}

TEST_CASE("What is not known of slope and roughness counts as nothing") {
  CHECK(cost(0.375f, NAN, NAN) == 31);
  CHECK(cost(0, NAN, 0.025f) == 42);
}

TEST_CASE("Lethal is lethal, and no height is unknown") {
  CHECK(cost(0, 0, 0, kDefault, kHard) == 254);
  CHECK(cost(0, 0, 0, kDefault, kSteep) == 254);
  CHECK(cost(0, 0, 0, kDefault, kNegative | kSoft) == 254);
  CHECK(cost(0, 0, 0, kDefault, kSoft | kAssumed) == 0);
  CHECK(column_cost(kDefault, kNegative, NAN, NAN, NAN, NAN) == 254);
  CHECK(column_cost(kDefault, 0, NAN, NAN, 0.1f, 0.1f) == 255);
}

TEST_CASE("A bush on flat ground costs 31, a 20-degree ramp 58, a bump of 0.1 m 1") {
  Rig bush, ramp, bump;
  bush.see(floor_points(-2, 12, -3, 3) + Points(3, {8.25, 0.25, 1.25}) + Points(5, {14.25, 0.25, 1.25}));
  CHECK(bush.column(8.25, 0.25).cost == 31);
  // slope 0.3490659 of 0.5 rad: 252 * 0.6981317 / 3 = 58.64
  ramp.see(surface(2, 12, -4, 4, [](double x, double) { return std::tan(20 * M_PI / 180) * (x - 2); }));
  CHECK(ramp.column(6.25, 1.25).cost == 58);
  // roughness 8 * 0.1^2 / 81 = 0.00098765 of 0.05 m^2: 252 * 0.019753 / 3 = 1.66; its slope is 0
  bump.see(surface(3, 8, -2, 3, [](double x, double y) { return x == 5.25 && y == 0.25 ? 0.15 : 0.05; }));
  CHECK(bump.column(5.25, 0.25).cost == 1);
}

}  // namespace
}  // namespace gvom::test
