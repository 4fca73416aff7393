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
  CHECK(rig.column(11.75, 1.25).slope == Approx(0.3490659).epsilon(1e-6));
  CHECK(std::isnan(rig.column(11.75, 3.75).slope));  // a corner: four columns
  CHECK(std::isnan(rig.column(13.25, 3.75).slope));
}

TEST_CASE("A wider plane smooths a bump") {
  const auto bump = [](double x, double y) { return x == 5.25 && y == 0.25 ? 0.15 : 0.05; };
  MapperConfig config = half_metre_map();
  config.layers.plane_size = 5;
  Rig narrow, wide(config);
  narrow.see(surface(3, 8, -2, 3, bump));
  wide.see(surface(3, 8, -2, 3, bump));
  CHECK(narrow.column(5.25, 0.25).roughness == Approx(8 * 0.01 / 81).epsilon(1e-6));
  CHECK(wide.column(5.25, 0.25).roughness == Approx(24 * 0.01 / 625).epsilon(1e-6));
}

TEST_CASE("Under the vehicle the ground is assumed where none was seen") {
  MapperConfig config = half_metre_map();
  config.vehicle.radius_m = 2.0;
  config.vehicle.base_height_m = 0.3;
  Rig rig(config);
  rig.see({{0.25, 0.75, 0.25}}, 1'000'000'000, {0, 0, 0.5});
  const ColumnValues under = rig.column(-1.25, 0.25);
  CHECK(under.height == 0.2f);
  CHECK(under.flags == kAssumed);
  CHECK(under.visibility == 2);
  CHECK(under.clearance == INFINITY);
  CHECK(under.cost == 0);
  CHECK(rig.column(0.25, 0.75).height == 0.25f);  // seen
  CHECK(rig.column(0.25, 0.75).flags == 0);
  CHECK(std::isnan(rig.column(-2.25, 0.25).height));  // 2.26 m away
  CHECK(rig.column(-1.75, 0.75).flags == kAssumed);   // 1.90 m away
  CHECK(rig.column(-1.75, 1.25).cost == 255);         // 2.15 m away
}

TEST_CASE("Assumed ground is the plane on which the vehicle stands, also when it leans") {
  MapperConfig config = half_metre_map();
  config.vehicle.base_height_m = 0.3;
  const auto under = [&](double lean_rad, const Eigen::Vector3d& about, double x_m, double y_m) {
    Rig rig(config);
    const Eigen::Quaterniond lean(Eigen::AngleAxisd(lean_rad, about));
    rig.see({{0.25, 14.25, 3.75}}, 1'000'000'000, {0, 0, 0.5}, lean);
    REQUIRE((rig.column(x_m, y_m).flags & kAssumed) != 0);
    return rig.column(x_m, y_m).height;
  };
  const Eigen::Vector3d pitch = Eigen::Vector3d::UnitY(), roll = Eigen::Vector3d::UnitX();
  CHECK(under(0.2, pitch, 1.25, 0.25) == Approx(0.2 - std::tan(0.2) * 1.25));  // nose down
  CHECK(under(0.2, pitch, -1.25, 0.25) == Approx(0.2 + std::tan(0.2) * 1.25));
  CHECK(under(0.2, roll, 0.25, 1.25) == Approx(0.2 + std::tan(0.2) * 1.25));  // to the right
  CHECK(under(1.0, roll, 0.25, 1.25) == Approx(0.2 + std::tan(1.0) * 1.25));
  CHECK(under(1.1, roll, 0.25, 1.25) == 0.2f);  // over 60 degrees it stands on nothing
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

// Level ground with nothing seen of one column's own, at (8.25, 0.25).
Points floor_but_one() {
  Points points;
  for (const Eigen::Vector3d& p : floor_points(2, 13, -4, 4))
    if (p.x() != 8.25 || p.y() != 0.25) points.push_back(p);
  return points;
}

TEST_CASE("A crown over hidden ground has the ground between the rims on both sides") {
  Rig rig;
  rig.see(floor_but_one() + Points{{8.25, 0.25, 3.05}});
  CHECK(rig.column(8.25, 0.25).height == Approx(0.05));
  CHECK(rig.column(8.25, 0.25).visibility == 3);
  CHECK(rig.column(8.25, 0.25).clearance == Approx(3.0));
  CHECK(rig.column(8.25, 0.25).flags == 0);
}

TEST_CASE("Between rims the ground is in proportion to its distance from them") {
  Rig rig;
  // To the left and to the right of the crown, 0.5 m and 1.5 m off: 0.3 m up on the way from 0.05 to 0.45.
  rig.see({{8.25, 0.75, 0.05}, {8.25, -1.25, 0.45}, {8.25, 0.25, 3.05}, {14.25, 0.25, 0.25}});
  CHECK(rig.column(8.25, 0.25).height == Approx(0.05 * 0.75 + 0.45 * 0.25));
}

TEST_CASE("A crown with ground on one side only has no height") {
  Rig rig;
  rig.see(floor_points(8.5, 13, -4, 4) + Points{{8.25, 0.25, 3.05}, {8.25, 0.75, 0.05}});
  CHECK(std::isnan(rig.column(8.25, 0.25).height));
  CHECK(rig.column(8.25, 0.25).visibility == 1);
  CHECK(rig.column(8.25, 0.25).cost == 255);
}

TEST_CASE("What hangs must have been passed below as often as it was hit") {
  // The rays to nine columns behind go below it; where it hangs, ground on one side says nothing.
  const auto height = [](std::size_t hits) {
    Rig rig;
    rig.see(floor_points(8.5, 13, 0, 0.5) + Points(hits, {8.25, 0.25, 1.05}));
    return rig.column(8.25, 0.25).height;
  };
  CHECK(std::isnan(height(9)));
  CHECK(height(10) == 1.05f);
}

// One column's return of height h, and a ray that leaves it 0.10 m up.
float height_with_ray_below(double h_m) {
  Rig rig;
  rig.see({{8.25, 0.25, h_m}, {8.75, 0.25, 1.25 - 1.15 * 8.5 / 8.25}});
  REQUIRE(rig.lowest_ray_m(8.25, 0.25) == Approx(0.10).epsilon(1e-3));
  return rig.column(8.25, 0.25).height;
}

TEST_CASE("A column whose rays went 0.2 m lower has the ray's height; 0.08 m are its own") {
  CHECK(height_with_ray_below(0.30) == Approx(0.10).epsilon(1e-3));
  CHECK(height_with_ray_below(0.18) == 0.18f);
}

TEST_CASE("A ray through the return's own voxel does not make it hang, and says nothing if it is far below") {
  CHECK(height_with_ray_below(0.39) == Approx(0.10).epsilon(1e-3));
  CHECK(height_with_ray_below(0.41) == 0.41f);
}

TEST_CASE("A single ray mirrored 1 m or more below well seen ground changes nothing") {
  for (const double below_m : {1.0, 2.5}) {
    Rig rig;
    rig.see(floor_points(2, 13, -4, 4) + Points(4, {8.25, 0.25, 0.05}) +
            Points{{8.75, 0.25, 1.25 - (1.2 + below_m) * 8.5 / 8.25}});
    REQUIRE(rig.lowest_ray_m(8.25, 0.25) == Approx(0.05 - below_m).epsilon(1e-3));
    CHECK(rig.column(8.25, 0.25).height == 0.05f);
  }
}

// A thing whose foot no ray reaches, on ground without a ray below it.
ColumnValues on_hidden_foot(double z_m) {
  Points points;
  for (const Eigen::Vector3d& p : floor_but_one())
    if (p.y() != 0.25 || p.x() < 8.25) points.push_back(p);
  Rig rig;
  rig.see(points + Points(5, {8.25, 0.25, z_m}));
  REQUIRE(std::isinf(rig.lowest_ray_m(8.25, 0.25)));
  return rig.column(8.25, 0.25);
}

TEST_CASE("A bush between lower ground on both sides stands out by more than ground bends") {
  CHECK(on_hidden_foot(0.85).height == Approx(0.05));
  CHECK((on_hidden_foot(0.85).flags & (kHard | kSoft)) != 0);
  CHECK(on_hidden_foot(0.18).height == Approx(0.05));  // 0.10 + 0.08 * 0.5^2 = 0.12 m over the next columns
  CHECK(on_hidden_foot(0.16).height == 0.16f);
}

TEST_CASE("Ground beside a ditch keeps its own height: on the other side there is none lower") {
  // From 8 to 10 m; over the near edge a ray comes 0.2 m down the far wall.
  Rig rig;
  rig.see(floor_points(2, 8, -4, 4) + floor_points(10, 14, -4, 4) +
          surface(9.5, 10, -4, 4, [](double, double) { return -0.2; }));
  CHECK(rig.column(7.75, 0.25).height == 0.05f);
  CHECK(rig.column(10.25, 0.25).height == 0.05f);
  CHECK(rig.column(9.75, 0.25).height == -0.2f);
}

TEST_CASE("A crown that no ray passed below, beside ground on one side, has no height") {
  Rig rig;
  rig.see(floor_points(2, 8, -4, 4) + Points{{8.25, 0.25, 3.05}, {8.75, 0.25, 3.45}});
  for (const double x : {8.25, 8.75}) {
    CHECK(std::isnan(rig.column(x, 0.25).height));
    CHECK(rig.column(x, 0.25).visibility == 1);
    CHECK(rig.column(x, 0.25).cost == 255);
  }
  CHECK(rig.column(7.75, 0.25).height == 0.05f);
}

TEST_CASE("An island of leaves without ground around it has no height") {
  // Nine columns; all but the middle one are over it by more than ground rises.
  const auto leaves = [](double x, double y) { return x == 8.25 && y == 0.25 ? 2.55 : 4.05 + 0.5 * y; };
  Rig rig;
  rig.see(surface(7.5, 9, -0.5, 1, leaves));
  CHECK(std::isnan(rig.column(8.25, 0.25).height));
  CHECK(std::isnan(rig.column(8.75, 0.75).height));
}

TEST_CASE("A face of 60 degrees, 3 m high and seen from below, keeps its ground up to its edge") {
  const auto face = [](double x, double) { return 0.05 + (x < 8 ? 0 : std::tan(M_PI / 3) * (x - 7.75)); };
  Rig rig;
  rig.see(surface(2, 10, -4, 4, face));
  for (const double x : {8.25, 8.75, 9.25, 9.75}) {
    CAPTURE(x);
    CHECK(rig.column(x, 0.25).height == Approx(0.05 + std::tan(M_PI / 3) * (x - 7.75)));
  }
}

TEST_CASE("Ground around a return mirrored 3 m below keeps its height") {
  Rig rig;
  rig.see(floor_but_one() + Points{{8.25, 0.25, -2.95}});
  for (const double x : {6.75, 7.75, 8.75, 9.75}) CHECK(rig.column(x, 0.25).height == 0.05f);
}

// One hit 1 m up, and rays over the same way that went on.
ColumnValues worn_by(int passes, const Points& ground) {
  Rig rig;
  rig.see(ground + Points{{8.25, 0.25, 1.05}} + Points(std::size_t(passes), {14.25, 0.25, 1.25}));
  return rig.column(8.25, 0.25);
}

TEST_CASE("A voxel of over 64 passes a hit is no ground, but an obstacle") {
  CHECK(worn_by(64, {}).height == 1.05f);
  CHECK(worn_by(64, {}).visibility == 3);
  CHECK(std::isnan(worn_by(65, {}).height));
  const ColumnValues on_ground = worn_by(65, {{8.25, 0.25, 0.05}});
  CHECK(on_ground.height == 0.05f);
  CHECK(on_ground.obstacle_density == static_cast<float>(1.0 / 66));
  CHECK(on_ground.flags == kSoft);
}

TEST_CASE("Noise of 0.15 m on level ground is rough, not steep; a face of 60 degrees is steep") {
  Rig noisy, face;
  unsigned state = 1;
  const auto noise = [&] { return ((state = state * 1103515245 + 12345) >> 16 & 0x7fff) / 32767.0 - 0.5; };
  noisy.see(surface(2, 14, -6, 6, [&](double, double) { return 0.05 + 0.15 * 3.46 * noise(); }));
  CHECK(noisy.flagged(kSteep).empty());
  CHECK(noisy.column(8.25, 0.25).roughness > 0.001f);
  face.see(surface(4, 8, -4, 4, [](double x, double) { return 0.05 + std::tan(M_PI / 3) * (x - 4); }));
  CHECK(face.column(6.25, 0.25).slope == Approx(M_PI / 3));
  CHECK((face.column(6.25, 0.25).flags & kSteep) != 0);
}

}  // namespace
}  // namespace gvom::test
