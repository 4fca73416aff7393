// What gvom-bench drives: a vehicle that never turns, on a grid that moves, with the same layers wherever a
// stretch of the drive begins.
#include <catch2/catch.hpp>

#include "tools/benchmark/measure.hpp"

namespace gvom::test {
namespace {

using namespace bench;

// Two sweeps, 1.6 m apart and 0.3 m up and down; a lap is 3.2 m, a brick of the default grid's voxels.
Recording two_sweeps() {
  Recording recording;
  recording.lap_m = {3.3, 0, 0.1};  // what is no whole brick is left out
  for (const double x_m : {0.0, 1.6}) {
    Sweep sweep;
    sweep.times_ns = {0};
    for (int i = 0; i < 40; ++i) sweep.returns.push_back({0.2 * i - 4, 3, 0.1 * i - 2, 0});
    recording.sweeps.push_back(sweep);
    Pose pose;
    pose.translation_m = {x_m, 0.1, x_m > 0 ? -0.15 : 0.15};
    recording.T_odom_base.push_back(pose);
  }
  return recording;
}

MapConfig small_grid() {
  MapConfig grid;
  grid.size_xy = 64;
  grid.size_z = 32;
  return grid;
}

TEST_CASE("each lap goes on in whole bricks, and the grid and the pose with it") {
  const Recording recording = two_sweeps();
  const auto voxelized = measure_voxelizing(Backend::cpu, small_grid(), recording, 2).value();
  const Drive drive{recording, voxelized.maps, small_grid(), 4};
  CHECK(drive.lap() == Int3{8, 0, 0});
  Memory memory(std::size_t{1} << 20);
  const BrickMapView first = drive.copy_map_of_tick(0, memory.begin());
  CHECK(first.grid.origin == Int3{-32, -32, -16});
  CHECK(first.T_odom_base.position_m[0] == 0);
  const BrickMapView later = drive.copy_map_of_tick(7, memory.begin());
  CHECK(later.grid.origin == Int3{-32 + 3 * 8, -32, -24});
  CHECK(later.T_odom_base.position_m[0] == Approx(1.6 + 3 * 3.2));
  CHECK(later.stamp_ns == 700'000'000);
}

TEST_CASE("bricks enter where the grid did not reach before") {
  Grid before{{0, 0, 0}, {64, 64, 32}, {0.4, 0.4, 0.4}};
  Grid grid = before;
  CHECK(bricks_entering(grid, before) == 0);
  grid.origin = {8, 0, 0};
  CHECK(bricks_entering(grid, before) == 8 * 4);
  grid.origin = {0, -16, 8};
  CHECK(bricks_entering(grid, before) == 8 * 8 * 4 - 8 * 6 * 3);
  grid.origin = {0, 640, 0};
  CHECK(bricks_entering(grid, before) == 8 * 8 * 4);
}

TEST_CASE("the street's grid moves along and up and down, in whole bricks, lap after lap") {
  const Recording street = make_street({"few beams", 2, 8, -0.3, 0.1});
  const auto voxelized = measure_voxelizing(Backend::cpu, small_grid(), street, street.sweeps.size()).value();
  const Drive drive{street, voxelized.maps, small_grid(), 4};
  CHECK(drive.lap() == Int3{32, 0, 0});
  const auto times =
      measure_ticks(Backend::cpu, drive, {ticks_before(drive), ticks_before(drive) + 44}).value();
  // Four bricks along x and two along z a lap of 11 ticks, some of them in one tick.
  CHECK(times.bricks_entering > 0.9 * (4 * 8 * 4 + 2 * 8 * 8) / 11.0);
  CHECK(times.bricks_entering <= (4 * 8 * 4 + 2 * 8 * 8) / 11.0);
}

TEST_CASE("the layers of a tick are the same wherever the stretch begins") {
  const Recording recording = two_sweeps();
  const auto voxelized = measure_voxelizing(Backend::cpu, small_grid(), recording, 2).value();
  const Drive drive{recording, voxelized.maps, small_grid(), 4};
  const int begin = ticks_before(drive);
  const auto whole = measure_ticks(Backend::cpu, drive, {begin, begin + 20}, {begin + 19}).value();
  const auto end = measure_ticks(Backend::cpu, drive, {begin + 15, begin + 20}, {begin + 19}).value();
  REQUIRE(whole.kept.size() == 1);
  REQUIRE(end.kept.size() == 1);
  CHECK(whole.kept[0].bytes == end.kept[0].bytes);
  CHECK(whole.both.size() == 20);
  CHECK(end.both.size() == 5);
}

}  // namespace
}  // namespace gvom::test
