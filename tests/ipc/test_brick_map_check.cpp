// What a map's arrays may hold, and by what name each fault goes.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "tests/ipc/two_bricks.hpp"

using namespace gvom;
using namespace gvom::ipc;
using gvom::ipc::test::TwoBricks;
using Part = MapFault::Part;

namespace {

/// The fault of a map with one thing wrong.
template <typename Spoil>
Part fault_of(const Spoil& spoil) {
  TwoBricks map;
  spoil(map);
  const auto sound = map.sample().validate_deep();
  REQUIRE_FALSE(sound.has_value());
  CHECK(sound.error().why.find("map refused: ") == 0);
  return sound.error().part;
}

}  // namespace

TEST_CASE("a map of two bricks, or of none, is sound") {
  CHECK(TwoBricks().sample().validate_deep().has_value());
  TwoBricks none(0, 0);
  CHECK(none.sample().validate_deep().has_value());
}

TEST_CASE("a directory that leads nowhere, or not to each brick once and in order, is a fault") {
  CHECK(fault_of([](TwoBricks& map) { map.directory()[1] = 2; }) == Part::directory);
  CHECK(fault_of([](TwoBricks& map) { map.directory()[3] = 0; }) == Part::directory);
  CHECK(fault_of([](TwoBricks& map) { map.directory()[1] = -2; }) == Part::directory);
  CHECK(fault_of([](TwoBricks& map) { map.directory()[1] = std::numeric_limits<std::int32_t>::min(); }) ==
        Part::directory);
  CHECK(fault_of([](TwoBricks& map) { map.directory()[3] = -1; }) == Part::directory);
  CHECK(fault_of([](TwoBricks& map) { std::swap(map.directory()[1], map.directory()[3]); }) ==
        Part::directory);
  CHECK(fault_of([](TwoBricks& map) { map.directory()[2] = 2; }) == Part::directory);
}

TEST_CASE("a voxel that leads to no record, and a record that no voxel leads to, are faults") {
  CHECK(fault_of([](TwoBricks& map) { map.lookup()[3] = 2; }) == Part::lookup);
  CHECK(fault_of([](TwoBricks& map) { map.lookup()[1023] = std::numeric_limits<std::int32_t>::max(); }) ==
        Part::lookup);
  CHECK(fault_of([](TwoBricks& map) { map.lookup()[3] = -5; }) == Part::lookup);  // the column stays observed
  CHECK(fault_of([](TwoBricks& map) { map.lookup()[4] = 1; }) == Part::lookup);
}

TEST_CASE("a column that was observed without its bit, or has it without, is a fault") {
  CHECK(fault_of([](TwoBricks& map) { map.columns()[0] = 0; }) == Part::columns);
  CHECK(fault_of([](TwoBricks& map) { map.columns()[1] |= std::uint64_t{1} << 63; }) == Part::columns);
  CHECK(fault_of([](TwoBricks& map) { map.lookup()[40] = -2; }) == Part::columns);
}

TEST_CASE("a ray's lowest point at no height is a fault") {
  for (const float height_m : {-INFINITY, NAN, -1e38F, 1e38F})
    CHECK(fault_of([&](TwoBricks& map) { map.lowest_ray_m()[255] = height_m; }) == Part::lowest_ray);
  TwoBricks map;
  map.lowest_ray_m()[255] = -0.5F;
  CHECK(map.sample().validate_deep().has_value());
}

TEST_CASE("a record without hits, or at no height, is a fault") {
  CHECK(fault_of([](TwoBricks& map) { map.records()[1].hits = 0; }) == Part::records);
  for (const float height_m : {INFINITY, -INFINITY, NAN, -1e38F})
    CHECK(fault_of([&](TwoBricks& map) { map.records()[0].min_height_m = height_m; }) == Part::records);
}
