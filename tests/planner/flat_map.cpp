#include "tests/planner/flat_map.hpp"

#include <cmath>
#include <limits>

namespace gvom::test {
namespace {

constexpr float kOpenSky = std::numeric_limits<float>::infinity();
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

}  // namespace

FlatMap::FlatMap(int edge)
    : n(edge),
      grid{{0, 0, 0}, {edge, edge, 64}, {kCell_m, kCell_m, kCell_m}},
      height(edge * edge, 0.0F),
      slope(edge * edge, 0.0F),
      roughness(edge * edge, 0.0F),
      clearance(edge * edge, kOpenSky),
      flags(edge * edge, 0),
      visibility(edge * edge, static_cast<std::uint8_t>(Visibility::ground_seen)) {}

void FlatMap::flag(int x0, int y0, int x1, int y1, std::uint8_t bits) {
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) flags[at(x, y)] |= bits;
  }
}

void FlatMap::forget(int x, int y) {
  const int i = at(x, y);
  height[i] = slope[i] = roughness[i] = clearance[i] = kNothing;
  flags[i] = visibility[i] = 0;
}

Eigen::Vector2d FlatMap::middle_m(int x, int y) const {
  return {(x + 0.5) * kCell_m, (y + 0.5) * kCell_m};
}

planner::MapView FlatMap::view() const {
  planner::MapView view;
  view.grid = grid;
  view.height = height.data();
  view.slope = slope.data();
  view.roughness = roughness.data();
  view.clearance = clearance.data();
  view.flags = flags.data();
  view.visibility = visibility.data();
  return view;
}

FlatMap random_map(Random& random, int edge, double trunks) {
  FlatMap map(edge);
  for (int y = 0; y < edge; ++y) {
    for (int x = 0; x < edge; ++x) {
      const int i = map.at(x, y);
      map.height[i] = static_cast<float>(random.uniform(0, 0.3));
      map.slope[i] = static_cast<float>(random.uniform(0, 0.6));
      map.roughness[i] = static_cast<float>(random.uniform(0, 0.03));
      if (random.chance(0.1)) map.flags[i] |= random.pick({kSoft, kSteep, kNegative});
      if (random.chance(trunks)) map.flags[i] |= kHard;
      if (random.chance(0.02)) map.clearance[i] = static_cast<float>(random.uniform(1, 3));
      if (random.chance(0.3)) map.forget(x, y);
    }
  }
  return map;
}

}  // namespace gvom::test
