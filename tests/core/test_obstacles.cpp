// What stands on the ground and what hangs over it (R11, R14).
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/rig.hpp"

namespace gvom::test {
namespace {

const Points kFloor = floor_points(-2, 12, -3, 3);

// Rays that end in the column (8.25, 0.25), at heights from `low_m` to `high_m`, and for each of them
// `passing` that go on at the same height.
Points thing(double low_m, double high_m, double step_m, std::size_t passing) {
  Points points;
  for (double z = low_m; z < high_m; z += step_m) {
    points.emplace_back(8.25, 0.25, z);
    const double on_m = 1.25 + (z - 1.25) * 15 / 8;
    points = points + Points(passing, {15.25, 0.25, on_m});
  }
  return points;
}

ColumnValues with(const Points& things, const LayersConfig& layers = {}) {
  MapperConfig config = half_metre_map();
  config.layers = layers;
  Rig rig(config);
  rig.see(kFloor + things);
  return rig.column(8.25, 0.25);
}

TEST_CASE("A tree trunk is hard") {
  Rig rig;
  rig.see(kFloor + thing(0.25, 3, 0.1, 0));
  const ColumnValues column = rig.column(8.25, 0.25);
  CHECK(column.height == 0.05f);
  CHECK(column.obstacle_density > 0.9f);
  CHECK(column.flags == kHard);
  CHECK(column.cost == 254);
  CHECK(rig.column(7.75, 0.25).flags == 0);
  CHECK(rig.column(8.25, 0.75).flags == 0);
}

TEST_CASE("A trunk thinner than a voxel is hard because it is tall") {
  const ColumnValues thin = with(thing(0.65, 2.2, 0.1, 4));
  CHECK(thin.obstacle_density < 0.25f);
  CHECK(thin.flags == kHard);
}

TEST_CASE("A bush of 1 m is soft, as thin as the trunk") {
  CHECK(with(thing(0.65, 1.1, 0.1, 4)).flags == kSoft);
  CHECK(with(thing(0.65, 1.1, 0.1, 4)).cost < 252);
}

TEST_CASE("Tall is what reaches an obstacle's greatest height, less a voxel") {
  CHECK(with(thing(0.65, 1.1, 0.1, 4) + Points{{8.25, 0.25, 1.5501}}).flags == kHard);
  CHECK(with(thing(0.65, 1.1, 0.1, 4) + Points{{8.25, 0.25, 1.5499}}).flags == kSoft);
}

TEST_CASE("A stack may have one empty layer in it, not two, and the columns around fill it") {
  const Points low = thing(0.65, 0.93, 0.05, 4);  // the layer from 0.5 to 1 m
  CHECK(with(low + Points{{8.25, 0.25, 1.85}}).flags == kHard);
  CHECK(with(low + Points{{8.25, 0.25, 2.05}}).flags == kSoft);
  CHECK(with(low + Points{{8.75, 0.75, 1.05}, {8.25, 0.25, 2.05}}).flags == kHard);
}

TEST_CASE("Dust is soft, however tall: hits must be a twentieth of the rays and 0.8 of their own root more") {
  // Two voxels, twelve hits; less one for each, ten: 10 - 0.8 sqrt(10) = 7.47 is a twentieth of 149.4.
  Points hits;
  for (int i = 0; i < 6; ++i) hits = hits + Points{{8.25, 0.25, 0.65}, {8.25, 0.25, 1.65}};
  hits = hits + Points{{8.75, 0.75, 1.25}};  // fills the layer between; its only ray is its hit
  const auto passing = [](std::size_t n) { return Points(n, {15.25, 0.25, 1.25 - 0.6 * 15 / 8}); };
  CHECK(with(hits + passing(139)).flags == kHard);  // 149 rays to spare
  CHECK(with(hits + passing(140)).flags == kSoft);  // 150
}

TEST_CASE("A stack of single hits of few rays is dust far out, though an eighth of its rays ends in it") {
  const Points five{
      {8.25, 0.25, 0.65}, {8.25, 0.25, 0.75}, {8.25, 0.25, 1.15}, {8.25, 0.25, 1.25}, {8.25, 0.25, 1.75}};
  const auto passing = [](std::size_t n) { return Points(n, {15.25, 0.25, 1.25}); };
  // Three voxels, two hits to spare: 2 - 0.8 sqrt(2) = 0.87 is a twentieth of 17.4.
  CHECK(with(five + passing(15)).flags == kHard);
  CHECK(with(five + passing(16)).flags == kSoft);
}

TEST_CASE("Three hits are too few to be hard") {
  CHECK(with(thing(0.65, 1.75, 0.5, 0)).flags == kSoft);
  CHECK(with(thing(0.65, 1.75, 0.3, 0)).flags == kHard);
}

// Some of the rays at the sensor's height stop in a bush, some go on.
Points bush(std::size_t stopped, std::size_t passed) {
  return Points(stopped, {8.25, 0.25, 1.25}) + Points(passed, {15.25, 0.25, 1.25});
}

TEST_CASE("A bush through which five of eight rays go is soft, of density 3/8") {
  const ColumnValues column = with(bush(3, 5));
  CHECK(column.obstacle_density == 0.375f);
  CHECK(column.flags == kSoft);
  CHECK(column.clearance == INFINITY);
}

TEST_CASE("Dense is from the threshold on, less one hit for each voxel") {
  CHECK(with(bush(5, 4)).flags == kHard);  // 4 of 8
  CHECK(with(bush(5, 5)).flags == kSoft);  // 4 of 9, though 5 of 10 is a half
  CHECK(with(bush(5, 5)).obstacle_density == 0.5f);
  LayersConfig low;
  low.density_threshold = 0.4;
  CHECK(with(bush(5, 5), low).flags == kHard);
}

TEST_CASE("The columns around say how dense a thing is") {
  const Points beside(4, {8.75, 0.75, 1.25});
  CHECK(with(bush(2, 3)).flags == kSoft);
  CHECK(with(bush(2, 3) + beside).flags == kHard);  // 4 of 7 with them, less a hit for each voxel
  CHECK(with(bush(2, 3) + beside).obstacle_density == 0.4f);
}

// A rock of 0.7 m: its face stops twelve rays, `over` go over it through the same voxel. In its shadow no ray
// meets the ground but one, at `seen_x_m`; nor does one beside it from `dark_beside_x_m` on.
ColumnValues rock(double seen_x_m, std::size_t over = 30, double dark_beside_x_m = 99) {
  Points points = Points(over, {15.25, 0.25, 1.25 - 0.45 * 15 / 8}) + Points{{seen_x_m, 0.25, 0.05}};
  for (const Eigen::Vector3d& p : kFloor)
    if ((p.x() < 8.5 || p.y() != 0.25) && (p.x() < dark_beside_x_m || p.y() < 0.5)) points.push_back(p);
  for (int i = 0; i < 12; ++i) points.emplace_back(8.25, 0.25, 0.59 + 0.01 * i);
  Rig rig;
  rig.see(points);
  return rig.column(8.25, 0.25);
}

TEST_CASE("A rock of 0.7 m is hard by its shadow, from two dark columns of four on") {
  CHECK(rock(8.25).flags == kHard);
  CHECK(rock(8.25).obstacle_density == static_cast<float>(12.0 / 42));
  CHECK(rock(9.75).flags == kHard);   // 8.75 and 9.25 are seen through
  CHECK(rock(10.25).flags == kSoft);  // and 9.75
}

TEST_CASE("A shadow that begins gradually is a bush's, if less than a quarter of the rays ends in it") {
  // Less a hit for the voxel, 11 of 44 rays, and 11 of 45.
  CHECK(rock(9.75, 33).flags == kHard);
  CHECK(rock(9.75, 34).flags == kSoft);
  CHECK(rock(8.25, 34).flags == kHard);       // dark from its face on
  CHECK(rock(9.75, 34, 8.6).flags == kHard);  // what is beside it is, too
  CHECK(rock(9.75, 34, 9.6).flags == kSoft);  // but not a step later
}

// A rock of half a metre: its top lies in the column (4.25, 0.75), its side in (4.25, 0.25), below all
// obstacle voxels. Behind that one `beyond` is seen over it.
ColumnValues low_rock(const Points& beyond) {
  Points points = beyond;
  for (const Eigen::Vector3d& p : kFloor)
    if (p.x() < 4.5 || p.y() != 0.25) points.push_back(p);
  for (int i = 0; i < 12; ++i) {
    points.emplace_back(4.25, 0.75, 0.51 + 0.005 * i);
    points.emplace_back(4.25, 0.25, 0.2 + 0.02 * i);
  }
  Rig rig;
  rig.see(points);
  return rig.column(4.25, 0.25);
}

TEST_CASE("A rock no higher than the ground's voxel is hard where rays come down again behind it") {
  // 0.43 m over the ground where they leave the column, 0.06 m four columns on.
  CHECK(low_rock({{6.75, 0.25, 0.05}}).flags == kHard);
  // 1.02 m and 0.93 m: what hides so much is no rock.
  CHECK(low_rock({{15.25, 0.25, 0.6}}).flags == 0);
  // Without what is beside it, it is ground.
  CHECK(with({}).flags == 0);
}

TEST_CASE("A wall is hard") {
  Points wall;
  for (double y = -2.75; y < 3; y += 0.5)
    for (double z = 0.25; z < 1.05; z += 0.1) wall.emplace_back(8.25, y, z);
  Rig rig;
  rig.see(floor_points(-2, 8.5, -3, 3) + wall);
  for (double y = -1.75; y < 2; y += 0.5) CHECK(rig.column(8.25, y).flags == kHard);
}

TEST_CASE("Density is weighted by rays over the column's obstacle voxels") {
  Rig rig;
  // A second obstacle voxel, of one hit, over the bush's; no ray goes through it.
  rig.see(kFloor + bush(3, 5) + Points{{8.25, 0.25, 1.55}});
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
  CHECK(over_ground(0.5).flags == kSoft);
  CHECK(over_ground(0.4999).flags == 0);  // the ground's own voxel
  CHECK(over_ground(2.0).flags == kSoft);
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
