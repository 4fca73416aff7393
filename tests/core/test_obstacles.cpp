// What stands on the ground and what hangs over it (R11, R14).
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/rig.hpp"

namespace gvom::test {
namespace {

const Points kFloor = floor_points(-2, 12, -3, 3);

// Three of eight rays stop in a bush at sensor height, five go on.
const Points kBush = Points(3, {8.25, 0.25, 1.25}) + Points(5, {14.25, 0.25, 1.25});

TEST_CASE("A tree trunk is hard") {
  Rig rig;
  Points trunk;
  for (double z = 0.25; z < 3; z += 0.1) trunk.emplace_back(8.25, 0.25, z);
  rig.see(kFloor + trunk);
  const ColumnValues column = rig.column(8.25, 0.25);
  CHECK(column.height == 0.05f);
  CHECK(column.obstacle_density > 0.9f);
  CHECK(column.flags == kHard);
  CHECK(column.cost == 254);
  CHECK(rig.column(7.75, 0.25).flags == 0);
  CHECK(rig.column(8.25, 0.75).flags == 0);
}

TEST_CASE("A bush through which five of eight rays go is soft, of density 3/8") {
  Rig rig;
  rig.see(kFloor + kBush);
  const ColumnValues column = rig.column(8.25, 0.25);
  CHECK(column.obstacle_density == 0.375f);
  CHECK(column.flags == kSoft);
  CHECK(column.clearance == INFINITY);
}

TEST_CASE("Half of the rays is hard: the threshold belongs to it") {
  Rig rig;
  rig.see(kFloor + kBush + Points(2, {8.25, 0.25, 1.25}));
  CHECK(rig.column(8.25, 0.25).obstacle_density == 0.5f);
  CHECK(rig.column(8.25, 0.25).flags == kHard);
}

TEST_CASE("Density is weighted by rays over the column's obstacle voxels") {
  Rig rig;
  // A second obstacle voxel, of one hit, over the bush's; no ray goes through it.
  rig.see(kFloor + kBush + Points{{8.25, 0.25, 1.55}});
  CHECK(rig.column(8.25, 0.25).obstacle_density == static_cast<float>(4.0 / 9.0));
}

TEST_CASE("A branch 2.5 m above the ground is clearance and no obstacle") {
  Rig rig;
  rig.see(kFloor + Points{{8.25, 0.25, 2.55}, {8.25, 0.25, 4.05}});
  const ColumnValues column = rig.column(8.25, 0.25);
  CHECK(column.clearance == Approx(2.5));
  CHECK(column.obstacle_density == 0);
  CHECK(column.flags == 0);
  CHECK(column.cost == 0);
  CHECK(rig.column(7.25, 0.25).clearance == INFINITY);
}

// Ground at 0 exactly and one thing above it, at exact heights.
ColumnValues over_ground(double height_m) {
  Rig rig;
  rig.see({{8.25, 0.25, 0.0}, {8.25, 0.25, height_m}});
  return rig.column(8.25, 0.25);
}

TEST_CASE("Obstacle heights belong to the obstacles, both ends") {
  CHECK(over_ground(0.5).flags == kHard);
  CHECK(over_ground(0.4999).flags == 0);  // the ground's own voxel
  CHECK(over_ground(2.0).flags == kHard);
  CHECK(over_ground(2.0).clearance == INFINITY);
  CHECK(over_ground(2.0001).flags == 0);
  CHECK(over_ground(2.0001).clearance == 2.0001f);
}

TEST_CASE("A step that is less than an obstacle above the lowest return is none") {
  Rig rig;
  rig.see({{8.25, 0.25, 0.3}, {8.25, 0.25, 0.7}});  // two voxels, 0.4 m apart
  CHECK(rig.column(8.25, 0.25).height == 0.3f);
  CHECK(rig.column(8.25, 0.25).flags == 0);
  CHECK(rig.column(8.25, 0.25).obstacle_density == 0);
}

}  // namespace
}  // namespace gvom::test
