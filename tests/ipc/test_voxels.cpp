// A map's voxels by their place, as a planner asks for them.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/ipc/two_bricks.hpp"

using namespace gvom;
using gvom::ipc::test::TwoBricks;

namespace {

/// Voxels (0, 16, 3) and (0, 24, 3) were hit once each, those above them passed once.
TwoBricks two_hits() {
  TwoBricks map;
  map.header().grid.origin = {-8, 16, 0};
  map.header().grid.resolution_m = {0.4, 0.4, 0.4};
  return map;
}

bool is_unknown(const VoxelRecord& voxel) {
  return voxel.hits == 0 && voxel.passes == 0 && std::isinf(voxel.min_height_m);
}

}  // namespace

TEST_CASE("a voxel is found by a point in it") {
  TwoBricks bricks = two_hits();
  const auto sample = bricks.sample();
  const BrickMapView map = sample.view();
  CHECK(map.voxel_at_m(0.1, 6.5, 1.3).hits == 1);
  CHECK(map.voxel_at_m(0.39, 9.99, 1.59).hits == 1);
  CHECK(map.voxel_at_m(0.1, 6.5, 1.3).min_height_m == 0.5F);
  CHECK(map.voxel_at_m(0.1, 6.5, 1.7).passes == 1);
  CHECK(is_unknown(map.voxel_at_m(-0.1, 6.5, 1.3)));
  CHECK(is_unknown(map.voxel_at_m(0.1, 6.5, 1.2)));  // 1.2 / 0.4 is less than 3 (R1)
}

TEST_CASE("a point beyond the grid, or none at all, is unknown") {
  TwoBricks bricks = two_hits();
  const auto sample = bricks.sample();
  const BrickMapView map = sample.view();
  for (const double far : {-3.3, 3.3, 1e300, -1e300, std::numeric_limits<double>::quiet_NaN()})
    CHECK(is_unknown(map.voxel_at_m(far, 6.5, 1.3)));
  CHECK(is_unknown(map.voxel_at_m(0.1, 6.5, -0.1)));
}

TEST_CASE("every voxel with hits is visited once, at its place") {
  TwoBricks bricks = two_hits();
  const auto sample = bricks.sample();
  const BrickMapView map = sample.view();
  std::vector<Int3> places;
  map.for_each_hit([&](const Int3& world, const VoxelRecord& voxel) {
    CHECK(voxel.hits == 1);
    places.push_back(world);
  });
  CHECK(places == std::vector<Int3>{{0, 16, 3}, {0, 24, 3}});
  CHECK(map.grid.center_m(places.front())[1] == Approx(6.6));
}
