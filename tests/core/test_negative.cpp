// Ditches and holes (R13).
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/rig.hpp"

namespace gvom::test {
namespace {

// Level ground with a ditch from x = 6 to 8 m. Over the near rim the sensor sees its far wall.
Points ground_with_ditch() {
  Points far_wall;
  for (double y = -2.75; y < 3; y += 0.5)
    for (const double z : {-0.3, -0.6, -0.9}) far_wall.emplace_back(8.1, y, z);
  return floor_points(-2, 6, -3, 3) + floor_points(8, 12, -3, 3) + far_wall;
}

TEST_CASE("A ditch is negative by how far the rays dip below its rim") {
  Rig rig;
  rig.see(ground_with_ditch());
  // Straight ahead the lowest ray is at -0.74 m where it enters the column of 7.75 m, -0.87 m where it
  // leaves.
  const ColumnValues column = rig.column(7.75, 0.25);
  CHECK(std::isnan(column.height));
  CHECK(column.inferred_height == -1.0f);
  CHECK(rig.column(8.25, 0.25).height == -0.9f);
  CHECK(column.negative_delta == Approx(0.05 - -1.0));
  CHECK(column.flags == kNegative);
  CHECK(column.cost == 254);
  // At 6.25 m it is at -0.46 m yet: a drop of 0.05 - -0.9, the far wall's.
  CHECK(rig.column(6.25, 0.25).inferred_height == -0.5f);
  CHECK(rig.column(6.25, 0.25).negative_delta == Approx(0.05 - -0.9));
  CHECK(rig.column(5.75, 0.25).negative_delta == 0);  // the rim itself is ground
  CHECK((rig.column(5.75, 0.25).flags & kNegative) == 0);
}

TEST_CASE("A column behind a wall is unknown, not a hole") {
  Rig rig;
  Points wall;
  for (double y = -2.75; y < 3; y += 0.5)
    for (double z = 0.25; z < 3; z += 0.25) wall.emplace_back(6.1, y, z);
  rig.see(floor_points(-2, 6, -3, 3) + wall);
  const ColumnValues behind = rig.column(7.25, 0.25);
  CHECK(behind.visibility == 0);
  CHECK(behind.negative_delta == 0);
  CHECK(behind.flags == 0);
  CHECK(behind.cost == 255);
}

TEST_CASE("Rays over level ground that was not hit make no hole") {
  Rig rig;
  rig.see(floor_points(3, 6, -3, 3) + floor_points(8, 12, -3, 3));
  CHECK(rig.column(6.75, 0.25).inferred_height >= 0);
  CHECK(rig.column(6.75, 0.25).negative_delta <= 0.05f);
  CHECK(rig.column(6.75, 0.25).flags == 0);
}

// A single ray at z = 1.25 m sees through (6.25, 0.25); the ground around it is placed by the test.
float delta_among(const Points& ground, int search_distance = 15) {
  MapperConfig config = half_metre_map();
  config.vehicle.radius_m = 0;
  config.layers.search_distance = search_distance;
  Rig rig(config);
  rig.see(Points{{15.25, 0.25, 1.25}} + ground);
  REQUIRE(rig.column(6.25, 0.25).inferred_height <= 1.0f);
  return rig.column(6.25, 0.25).negative_delta;
}

TEST_CASE("The search goes no farther than its distance") {
  CHECK(delta_among({{6.25, 4.25, 3.3}}, 8) == Approx(3.3 - 1.0));
  CHECK(delta_among({{6.25, 4.25, 3.3}}, 7) == 0);
}

TEST_CASE("The search widens as it goes, and stops at the first row with ground") {
  // +y only: at distance 2, two columns aside, 4 m; farther on, straight, 5 m.
  CHECK(delta_among({{7.25, 1.25, 4.3}, {6.25, 1.75, 5.3}}, 2) == Approx(4.3 - 1.0));
  CHECK(delta_among({{7.25, 0.75, 4.3}}, 1) == 0);  // at distance 1 it is two aside of +y, and of +x two away
}

TEST_CASE("Of ground at one distance the least sideways counts, of two alike the negative side") {
  CHECK(delta_among({{6.75, 1.75, 4.3}, {5.25, 1.75, 5.3}}, 3) == Approx(4.3 - 1.0));
  CHECK(delta_among({{5.75, 1.75, 4.3}, {6.75, 1.75, 5.3}}, 3) == Approx(4.3 - 1.0));
}

}  // namespace
}  // namespace gvom::test
