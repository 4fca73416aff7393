// Ground: seen, assumed and inferred (R9, R10, R15), and its slope (R12).
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/rig.hpp"

namespace gvom::test {
namespace {

const double kRamp = std::tan(20 * M_PI / 180);

Points ramp() {
  return surface(2, 12, -4, 4, [](double x, double) { return 0.05 + kRamp * (x - 2); });
}

TEST_CASE("A flat floor has its height, no slope and no obstacle") {
  Rig rig;
  rig.see(floor_points(-10, 10, -10, 10));
  for (const double x : {-8.25, 0.25, 3.75, 8.25}) {
    CAPTURE(x);
    const ColumnValues column = rig.column(x, 2.25);
    CHECK(column.height == 0.05f);
    CHECK(column.slope_x == 0);
    CHECK(column.slope_y == 0);
    CHECK(column.slope == 0);
    CHECK(column.roughness == Approx(0).margin(1e-15));
    CHECK(column.obstacle_density == 0);
    CHECK(column.negative_delta == 0);
    CHECK(column.clearance == INFINITY);
    CHECK(column.flags == 0);
    CHECK(column.visibility == 3);
    CHECK(column.cost == 0);
  }
}

TEST_CASE("A ramp of 20 degrees slopes by 0.349 rad and is no obstacle") {
  Rig rig;
  rig.see(ramp());
  const ColumnValues column = rig.column(6.25, 1.25);
  CHECK(column.height == Approx(0.05 + kRamp * 4.25));
  CHECK(column.slope_x == Approx(kRamp).epsilon(1e-6));
  CHECK(column.slope_y == Approx(0).margin(1e-6));
  CHECK(column.slope == Approx(0.3490659).epsilon(1e-6));
  CHECK(column.roughness == Approx(0).margin(1e-9));
  CHECK(column.obstacle_density == 0);
  CHECK(column.flags == 0);
}

TEST_CASE("A ramp over the threshold is steep and lethal") {
  MapperConfig config = half_metre_map();
  config.layers.slope_threshold_rad = 0.349;
  Rig rig(config);
  rig.see(ramp());
  CHECK(rig.column(6.25, 1.25).flags == kSteep);
  CHECK(rig.column(6.25, 1.25).cost == 254);
}

TEST_CASE("At a surface's edge the plane is of the columns there are") {
  Rig rig;
  rig.see(ramp());
  CHECK(rig.column(11.75, 3.75).slope == Approx(0.3490659).epsilon(1e-6));
  CHECK(std::isnan(rig.column(13.25, 3.75).slope));
}

TEST_CASE("A wider plane smooths a bump") {
  const auto bump = [](double x, double y) { return x == 5.25 && y == 0.25 ? 0.3 : 0.05; };
  MapperConfig config = half_metre_map();
  config.layers.plane_size = 5;
  Rig narrow, wide(config);
  narrow.see(surface(3, 8, -2, 3, bump));
  wide.see(surface(3, 8, -2, 3, bump));
  CHECK(narrow.column(5.25, 0.25).roughness == Approx(8 * 0.0625 / 81).epsilon(1e-6));
  CHECK(wide.column(5.25, 0.25).roughness == Approx(24 * 0.0625 / 625).epsilon(1e-6));
}

TEST_CASE("Under the vehicle the ground is assumed where none was seen") {
  MapperConfig config = half_metre_map();
  config.vehicle.radius_m = 2.0;
  config.vehicle.base_height_m = 0.3;
  Rig rig(config);
  rig.see({{0.25, 0.75, 0.75}}, 1'000'000'000, {0, 0, 0.5});
  const ColumnValues under = rig.column(-1.25, 0.25);
  CHECK(under.height == 0.2f);
  CHECK(under.flags == kAssumed);
  CHECK(under.visibility == 2);
  CHECK(under.clearance == INFINITY);
  CHECK(under.cost == 0);
  CHECK(rig.column(0.25, 0.75).height == 0.75f);  // seen
  CHECK(rig.column(0.25, 0.75).flags == 0);
  CHECK(std::isnan(rig.column(-2.25, 0.25).height));  // 2.26 m away
  CHECK(rig.column(-1.75, 0.75).flags == kAssumed);   // 1.90 m away
  CHECK(rig.column(-1.75, 1.25).cost == 255);         // 2.15 m away
}

TEST_CASE("A column whose centre is exactly on the radius is under the vehicle") {
  MapperConfig config = half_metre_map();
  config.vehicle.radius_m = 1.25;  // (0.75, 1.0) from a vehicle at (0.5, 0.25)
  Rig rig(config);
  rig.see({{10.25, 0.25, 1.25}}, 1'000'000'000, {0.5, 0.25, 0});
  CHECK(rig.column(1.25, 1.25).flags == kAssumed);
  config.vehicle.radius_m = std::nextafter(1.25, 0.0);
  Rig smaller(config);
  smaller.see({{10.25, 0.25, 1.25}}, 1'000'000'000, {0.5, 0.25, 0});
  CHECK(smaller.column(1.25, 1.25).flags == 0);
}

TEST_CASE("Where rays went over no ground, it is at most as high as the lowest of them") {
  Rig rig;
  rig.see({{9.25, 0.25, 1.25}, {9.25, 0.25, 0.25}});
  const ColumnValues column = rig.column(6.25, 0.25);  // the lower ray is at 0.58 m here
  CHECK(std::isnan(column.height));
  CHECK(column.inferred_height == 0.5f);
  CHECK(column.visibility == 1);
  CHECK(std::isnan(column.obstacle_density));
  CHECK(std::isnan(column.clearance));
  CHECK(column.cost == 255);
  CHECK(rig.column(6.25, 5.25).visibility == 0);
  CHECK(std::isnan(rig.column(6.25, 5.25).inferred_height));
}

}  // namespace
}  // namespace gvom::test
