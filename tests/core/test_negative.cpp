// Holes: where a ray has been below the ground that should be there (R13).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/rig.hpp"
#include "tests/core/scan.hpp"

namespace gvom::test {
namespace {

using Places = std::vector<std::array<double, 2>>;

// A level sweep from the origin, on ground of height `z_m(x, y)`.
template <class Height>
Rig rig_on(Height&& z_m) {
  Rig rig;
  rig.see(scan({0, 0, 0}, z_m));
  return rig;
}

// Sweeps on a slope, one each 0.37 m along x, the vehicle leaning with it. @param up_rad the way up, from the
// x axis
Rig rig_on_slope(double slope_rad, double up_rad, int sweeps = 1) {
  const Eigen::Vector3d across(std::sin(up_rad), -std::cos(up_rad), 0);
  const Eigen::Quaterniond lean(Eigen::AngleAxisd(slope_rad, across));
  const auto z_m = [&](double x, double y) {
    return std::tan(slope_rad) * (std::cos(up_rad) * x + std::sin(up_rad) * y);
  };
  Rig rig;
  for (int i = 0; i < sweeps; ++i) {
    const Eigen::Vector3d vehicle_m(0.37 * i, 0, z_m(0.37 * i, 0));
    rig.see(scan(vehicle_m, z_m, lean), 1'000'000'000 + i * 100'000'000, vehicle_m, lean);
  }
  return rig;
}

bool holds(const Places& places, double x_m, double y_m) {
  return std::find(places.begin(), places.end(), std::array<double, 2>{x_m, y_m}) != places.end();
}

double nearest_x_m(const Places& places) {
  double nearest_m = INFINITY;
  for (const auto& at : places) nearest_m = std::min(nearest_m, at[0]);
  return nearest_m;
}

// 2 m wide and 1 m deep, across the vehicle's way.
double ditch_z_m(double x_m) {
  return x_m >= 6 && x_m < 8 ? -1 : 0;
}

TEST_CASE("Level ground has no hole in the gaps between the rings of a lidar") {
  Rig rig = rig_on([](double, double) { return 0.0; });
  CHECK(rig.column(10.25, 0.25).visibility == 3);
  CHECK(rig.flagged(kNegative).empty());
  int gaps = 0;
  for (double x = 5.25; x < 15; x += 0.5) gaps += rig.column(x, 0.25).visibility == 1 ? 1 : 0;
  CHECK(gaps >= 3);
}

TEST_CASE("A slope of 25 degrees has no hole within 10 m, up, down or sideways") {
  for (const double up_rad : {0.0, 0.3, M_PI / 4, M_PI / 2, M_PI}) {
    CAPTURE(up_rad);
    Rig rig = rig_on_slope(25 * M_PI / 180, up_rad);
    REQUIRE(rig.column(8.25, 0.25).visibility != 0);
    for (const auto& at : rig.flagged(kNegative)) CHECK(std::max(std::abs(at[0]), std::abs(at[1])) > 10);
  }
}

TEST_CASE("After eight sweeps on the way up a slope of 25 degrees has no hole at all") {
  for (const double up_rad : {0.0, 0.3, M_PI / 4})
    CHECK(rig_on_slope(25 * M_PI / 180, up_rad, 8).flagged(kNegative) == Places{});
}

TEST_CASE("A slope of 15 degrees isn't steep, wherever on it the rings of a lidar lie") {
  for (const double up_rad : {0.0, 0.3, M_PI / 4, M_PI / 2, M_PI})
    CHECK(rig_on_slope(15 * M_PI / 180, up_rad).flagged(kSteep) == Places{});
}

TEST_CASE("A ditch of 2 m is a hole in the same columns, wherever its ground lies within a voxel") {
  const auto found = [](double ground_m) {
    Rig rig;
    const auto z_m = [&](double x, double) { return ground_m + ditch_z_m(x); };
    rig.see(scan({0, 0, ground_m}, z_m), 1'000'000'000, {0, 0, ground_m});
    return rig.flagged(kNegative);
  };
  const Places due = found(0.01);
  CHECK(holds(due, 6.75, 0.25));
  CHECK(holds(due, 7.75, 0.25));
  CHECK(nearest_x_m(due) > 6);
  CHECK(found(0.13) == due);
  CHECK(found(0.33) == due);
}

TEST_CASE("A ditch is as deep as its far wall is seen") {
  Rig rig = rig_on([](double x, double) { return ditch_z_m(x); });
  // A ray over the near edge is 1.25 / 5.75 steep: 0.43 m down the far wall, 0.38 m with a beam's step.
  CHECK(rig.column(7.75, 0.25).negative_delta < 0.44f);
  CHECK(rig.column(7.75, 0.25).negative_delta > 0.30f);
  CHECK(rig.column(6.75, 0.25).negative_delta < 0.22f);
  CHECK(rig.column(5.25, 0.25).negative_delta == 0);
  CHECK(rig.column(7.75, 0.25).cost == 254);
}

TEST_CASE("A drop must show by more than 0.08 of the depth that matters, and noise") {
  MapperConfig config = half_metre_map();
  config.layers.negative_threshold_m = 4.0;  // 0.32 m, and 0.023 m for 7.5 m of range
  Rig strict(config);
  strict.see(scan({0, 0, 0}, [](double x, double) { return ditch_z_m(x); }));
  const Places found = strict.flagged(kNegative);
  CHECK(holds(found, 7.75, 0.25));        // 0.36 m down
  CHECK_FALSE(holds(found, 6.75, 0.25));  // 0.22 m down at most
  for (const auto& at : found) CHECK(strict.column(at[0], at[1]).negative_delta > 0.342f);
}

TEST_CASE("The edge of a cliff shows by rays below level") {
  const Places found = rig_on([](double x, double) { return x < 6 ? 0.0 : -5.0; }).flagged(kNegative);
  CHECK(holds(found, 8.25, 0.25));
  CHECK(nearest_x_m(found) > 6);
  CHECK(nearest_x_m(found) < 8);
}

TEST_CASE("No edge is carried on farther than two fifths of the search distance") {
  MapperConfig config = half_metre_map();
  config.layers.search_distance = 10;  // 4 columns: to 7.75
  Rig rig(config);
  rig.see(scan({0, 0, 0}, [](double x, double) { return x < 6 ? 0.0 : -5.0; }));
  CHECK(rig.column(7.75, 0.25).negative_delta > 0);
  CHECK(rig.column(8.75, 0.25).negative_delta == 0);
}

TEST_CASE("A crest that bends gently is no edge") {
  // Behind x = 4 m the ground falls on a circle of 20 m, to 6 m down; seen over its highest point, 8 m off,
  // it is hidden to the foot.
  const auto crest = [](double x, double) { return x < 4 ? 0.0 : std::max(-(x - 4) * (x - 4) / 40, -6.0); };
  Rig rig = rig_on(crest);
  CHECK(rig.column(12.25, 0.25).visibility == 1);
  CHECK(rig.flagged(kNegative).empty());
}

TEST_CASE("A ramp of 15 degrees that begins with a curve is no edge") {
  // A circle of 8 m: two metres of curve. Seen from eight places it is hidden behind its own beginning.
  const auto ramp = [](double x, double) {
    const double curve_m = std::min(x - 10, 8 * 0.268);
    return x < 10 ? 0.0 : std::max(-curve_m * curve_m / 16 - 0.268 * (x - 10 - curve_m), -3.0);
  };
  Rig rig;
  for (int i = 0; i < 8; ++i)
    rig.see(scan({0.37 * i, 0, 0}, ramp), 1'000'000'000 + i * 100'000'000, {0.37 * i, 0, 0});
  CHECK(rig.column(12.75, 0.25).visibility == 1);
  CHECK(rig.flagged(kNegative).empty());
}

// Ground that rises to x = 2.5 m, and rays that pass closely over its end.
Places found_behind_rise(double slope) {
  Points points;
  const double over_m = 1.25 - (2.5 * slope + 0.02);
  for (const double y : {-0.75, -0.25, 0.25, 0.75}) {
    for (double x = -1.75; x < 2.5; x += 0.5) points.emplace_back(x, y, slope * x);
    points.emplace_back(6.75, y, 1.25 - over_m * 6.75 / 2.5);
  }
  Rig rig;
  rig.see(points);
  return rig.flagged(kNegative);
}

TEST_CASE("Behind ground that rises by 0.3 there is an edge, behind steeper ground none") {
  CHECK(holds(found_behind_rise(0.3), 6.25, 0.25));
  CHECK(found_behind_rise(0.36).empty());
}

TEST_CASE("A car's hood beside the vehicle is no edge though the road before it isn't seen") {
  Points points;
  for (double y = -2.75; y < 3; y += 0.5) {
    for (const double x : {3.25, 3.75, 4.25}) points.emplace_back(x, y, 0.6);
    points.emplace_back(8.25, y, 0.05);
  }
  Rig rig;
  rig.see(points);
  CHECK(rig.column(6.75, 0.25).visibility == 1);
  CHECK(rig.flagged(kNegative).empty());
}

TEST_CASE("A ray that ran below ground that is seen on its way was mirrored: there is no hole") {
  Points ground;
  for (const Eigen::Vector3d& p : floor_points(-2, 14, -3, 3))
    if (p.x() < 5 || p.x() > 8) ground.push_back(p);
  Points mirrored;
  for (const double y_m : {-0.75, -0.25, 0.25, 0.75}) mirrored.emplace_back(7.9, y_m, -2.5);
  Rig rig;
  rig.see(ground + ground + ground + mirrored);
  CHECK(rig.column(4.75, 0.25).visibility == 3);
  CHECK(rig.column(6.25, 0.25).visibility == 1);
  CHECK(rig.flagged(kNegative).empty());
}

// Level ground but for some rows of it, where it isn't seen from x = 2 m on, until a ray ends in `bottom`.
Points ground_with_gaps(const std::vector<double>& gaps_y_m, double bottom_x_m, double bottom_z_m) {
  Points points;
  for (const Eigen::Vector3d& p : floor_points(-2, 14, -3, 3)) {
    const bool in_row = std::find(gaps_y_m.begin(), gaps_y_m.end(), p.y()) != gaps_y_m.end();
    if (!(in_row && p.x() > 2 && p.x() < bottom_x_m + 0.25)) points.push_back(p);
  }
  for (const double y_m : gaps_y_m) points.emplace_back(bottom_x_m, y_m, bottom_z_m);
  return points;
}

TEST_CASE("A single column is no hole: two of its neighbours must show one, too") {
  Rig one, two, three;
  one.see(ground_with_gaps({0.25}, 2.52, -0.1));
  two.see(ground_with_gaps({0.25, 0.75}, 2.52, -0.1));
  three.see(ground_with_gaps({-0.25, 0.25, 0.75}, 2.52, -0.1));
  CHECK(one.column(2.25, 0.25).negative_delta == Approx(0.05 - (1.25 - 1.35 * 2.25 / 2.27)).epsilon(1e-3));
  CHECK(one.flagged(kNegative).empty());
  CHECK(two.flagged(kNegative).empty());
  CHECK(three.flagged(kNegative) == Places{{2.25, 0.25}});  // the outer ones have one neighbour each
}

TEST_CASE("A streak away from the vehicle is no hole, two of them side by side are one") {
  Rig streak, wide;
  streak.see(ground_with_gaps({0.25}, 3.02, -0.6));
  wide.see(ground_with_gaps({0.25, 0.75}, 3.02, -0.6));
  for (const double x_m : {2.25, 2.75, 3.25}) CHECK(streak.column(x_m, 0.25).negative_delta > 0.2f);
  CHECK(streak.flagged(kNegative).empty());
  CHECK(wide.flagged(kNegative) ==
        Places{{2.25, 0.25}, {2.75, 0.25}, {3.25, 0.25}, {2.25, 0.75}, {2.75, 0.75}, {3.25, 0.75}});
}

// Level ground with a pothole of a metre, whose bottom is seen where its rim lets rays pass.
Points pothole(double nearer_z_m, double farther_z_m) {
  Points points;
  for (const Eigen::Vector3d& p : floor_points(-2, 14, -3, 3))
    if (!(p.x() > 4 && p.x() < 5 && p.y() > 0 && p.y() < 1)) points.push_back(p);
  for (const double y_m : {0.25, 0.75}) {
    points.emplace_back(4.45, y_m, nearer_z_m);
    points.emplace_back(4.95, y_m, farther_z_m);
  }
  return points;
}

TEST_CASE("A pothole is a hole though its bottom is seen: ground below that on both sides") {
  Rig deep, shallow;
  deep.see(pothole(-0.2, -0.3));
  CHECK(deep.column(4.75, 0.25).visibility == 3);
  CHECK(deep.column(4.25, 0.25).negative_delta == 0.05f + 0.2f);
  CHECK(deep.column(4.75, 0.25).negative_delta == 0.05f + 0.3f);
  CHECK(deep.flagged(kNegative) == Places{{4.25, 0.25}, {4.75, 0.25}, {4.25, 0.75}, {4.75, 0.75}});
  // Across a corner, one column off, 0.3 of the half metre that matters must show, and 0.04 m for ground
  // bends.
  shallow.see(pothole(-0.13, -0.13));
  CHECK(shallow.column(4.75, 0.25).height == -0.13f);
  CHECK(shallow.flagged(kNegative).empty());
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

TEST_CASE("Without ground on this side there is no hole") {
  MapperConfig config = half_metre_map();
  config.vehicle.radius_m = 0;
  Rig rig(config);
  const Points beyond = floor_points(8, 12, -3, 3) + Points(3, {8.1, 0.25, -0.6});
  rig.see(beyond);
  CHECK(rig.column(7.75, 0.25).visibility == 1);
  CHECK(rig.column(7.75, 0.25).negative_delta == 0);
  rig.see(floor_points(2, 6, -3, 3), 1'100'000'000);
  CHECK(rig.column(7.75, 0.25).negative_delta > 0);
}

TEST_CASE("The rim is looked for no farther than the search distance") {
  MapperConfig config = half_metre_map();
  config.layers.search_distance = 3;
  Rig rig(config);
  rig.see(scan({0, 0, 0}, [](double x, double) { return ditch_z_m(x); }));
  CHECK(rig.column(7.25, 0.25).negative_delta > 0);   // the third from the last rim, at 5.75
  CHECK(rig.column(7.75, 0.25).negative_delta == 0);  // the fourth
}

}  // namespace
}  // namespace gvom::test
