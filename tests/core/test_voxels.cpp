// Hits and passes of a sweep (R1, R4..R6), and what their sums say (R8).
#include <catch2/catch.hpp>
#include <cmath>

#include "core/grid.hpp"
#include "tests/core/rig.hpp"

namespace gvom::test {
namespace {

TEST_CASE("A grid's origin is half its size below the vehicle, lowered to a whole brick") {
  const MapConfig map{0.5, 0.25, 64, 32};
  CHECK(grid_around(map, {0, 0, 0}).origin == Int3{-32, -32, -16});
  CHECK(grid_around(map, {3.99, -0.01, 1.99}).origin == Int3{-32, -40, -16});
  CHECK(grid_around(map, {4.0, -4.0, 2.0}).origin == Int3{-24, -40, -8});
  CHECK(grid_around(map, {-4.01, 1000, -2.01}).origin == Int3{-48, 1968, -32});
  CHECK(grid_around({0.4, 0.4, 264, 8}, {0, 0, 0}).origin == Int3{-136, -136, -8});
}

// 1.2 / 0.4 and 4.8 / 0.4 are, as doubles, below 3 and 12; the products with 1 / 0.4 are 3 and 12.
TEST_CASE("A voxel is the floor of a division, not of a product with the reciprocal") {
  const MapConfig map{0.4, 0.4, 8, 8};
  CHECK(grid_around(map, {4.8, 0, 0}).origin == Int3{0, -8, -8});
  CHECK(grid_around(map, {0, 4.8, 0}).origin == Int3{-8, 0, -8});
  CHECK(grid_around(map, {0, 0, 4.8}).origin == Int3{-8, -8, 0});

  MapperConfig config;
  config.map = {0.4, 0.4, 64, 64};
  OdometryBuffer odometry(1);
  odometry.add({0, {}});
  Sweep sweep;
  sweep.times_ns = {0};
  sweep.returns = {{1.2, 2.4, 4.8, 0}};
  SweepMapper mapper(config, LidarGeometry{}, 1);
  BrickMapStorage storage;
  const auto shape = mapper.count(sweep, odometry);
  REQUIRE(shape);
  mapper.write(storage.resize(*shape));
  const BrickMapView seen = storage.view(mapper.grid(), 0, mapper.T_odom_base());
  const std::int32_t brick = seen.brick_at({0, 0, 1});
  REQUIRE(brick >= 0);
  CHECK(seen.lookup[brick * kBrickCells + static_cast<int>(cell_in_brick(2, 5, 11))] == 0);
}

TEST_CASE("A return 10 m ahead is one hit and a pass in each of the 20 voxels before it") {
  Rig rig;
  rig.see({{10.25, 0.25, 1.25}});
  CHECK(rig.voxel(10.25, 0.25, 1.25).hits == 1);
  CHECK(rig.voxel(10.25, 0.25, 1.25).passes == 0);
  CHECK(rig.voxel(10.25, 0.25, 1.25).min_height_m == 1.25f);
  for (int i = 0; i < 20; ++i) {
    CHECK(rig.voxel(0.25 + 0.5 * i, 0.25, 1.25).passes == 1);
    CHECK(rig.voxel(0.25 + 0.5 * i, 0.25, 1.25).hits == 0);
  }
  CHECK(rig.total().hits == 1);
  CHECK(rig.total().passes == 20);
}

TEST_CASE("A wall 10 m ahead is hit in the wall's voxels and in no other") {
  Rig rig;
  Points wall;
  for (double y = -4.75; y < 5; y += 0.5)
    for (double z = 0.25; z < 3; z += 0.5) wall.emplace_back(10.25, y, z);
  rig.see(wall);
  for (const Eigen::Vector3d& p : wall) CHECK(rig.voxel(p.x(), p.y(), p.z()).hits == 1);
  CHECK(rig.total().hits == wall.size());
  CHECK(rig.voxel(0.25, 0.25, 1.25).passes == wall.size());  // the sensor's own voxel
  for (const Eigen::Vector3d& p : wall) CHECK(rig.voxel(p.x() + 0.5, p.y(), p.z()).passes == 0);
}

TEST_CASE("A return beyond the grid clears the voxels on its way") {
  Rig rig;  // up to x = 16 m
  rig.see({{500.25, 0.25, 1.25}});
  CHECK(rig.total().hits == 0);
  CHECK(rig.total().passes == 32);
  CHECK(rig.voxel(15.75, 0.25, 1.25).passes == 1);
}

TEST_CASE("A ray that leaves the grid and comes to its height again counts within it only") {
  Rig rig;  // z from -16 to 16 m: the ray is out at the top after 14.75 of 100 m
  rig.see({{0.25, 0.25, 101.25}});
  CHECK(rig.total().passes == 30);
}

TEST_CASE("A return in the sensor's own voxel is a hit without a pass") {
  Rig rig;
  rig.see({{0.3, 0.2, 1.1}, {0.25, 0.25, 1.25}});
  CHECK(rig.voxel(0.25, 0.25, 1.25).hits == 2);
  CHECK(rig.total().passes == 0);
}

TEST_CASE("A voxel's height is its lowest return's, as float") {
  Rig rig;
  rig.see({{5.25, 0.25, 1.4}, {5.3, 0.2, 1.1}, {5.25, 0.25, 1.3}});
  CHECK(rig.voxel(5.25, 0.25, 1.25).hits == 3);
  CHECK(rig.voxel(5.25, 0.25, 1.25).min_height_m == 1.1f);
}

TEST_CASE("A height that rounds to minus zero is zero, in the voxel below") {
  LidarGeometry lidar;
  OdometryBuffer odometry(1);
  odometry.add({0, {}});
  Sweep sweep;
  sweep.times_ns = {0};
  sweep.returns = {{5.25, 0.25, -1e-60, 0}};
  SweepMapper mapper(half_metre_map(), lidar, 1);
  BrickMapStorage storage;
  const auto shape = mapper.count(sweep, odometry);
  REQUIRE(shape);
  REQUIRE(shape->record_count == 1);
  mapper.write(storage.resize(*shape));
  const BrickMapView map = storage.view(mapper.grid(), 0, mapper.T_odom_base());
  CHECK(map.records[0].min_height_m == 0);
  CHECK_FALSE(std::signbit(map.records[0].min_height_m));
  CHECK(map.brick_at({1, 0, -1}) >= 0);
  CHECK(map.lookup[map.brick_at({1, 0, -1}) * kBrickCells + static_cast<int>(cell_in_brick(10, 0, -1))] == 0);
}

TEST_CASE("A voxel of too few hits is free, and its hits stay") {
  MapperConfig config = half_metre_map();
  config.layers.min_hits = 2;
  Rig rig(config);
  rig.see({{5.25, 0.25, 1.25}, {6.25, 0.25, 1.25}, {6.25, 0.25, 1.3}});
  CHECK(rig.voxel(5.25, 0.25, 1.25).hits == 1);
  CHECK(rig.voxel(5.25, 0.25, 1.25).passes == 2);
  CHECK(rig.column(5.25, 0.25).visibility == 1);
  CHECK(rig.column(5.25, 0.25).inferred_height == 1.0f);
  CHECK(rig.column(6.25, 0.25).visibility == 3);
  rig.see({{5.25, 0.25, 1.45}}, 1'100'000'000);
  CHECK(rig.column(5.25, 0.25).visibility == 3);
  CHECK(rig.column(5.25, 0.25).height == 1.25f);
}

}  // namespace
}  // namespace gvom::test
