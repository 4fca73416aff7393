// What is remembered beyond the window (R17).
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/rig.hpp"

namespace gvom::test {
namespace {

constexpr std::int64_t kBeat_ns = std::int64_t{1} << 29;  // of the memory
const Points kElsewhere{{0.25, 5.25, 1.25}};
const Points kFloor = floor_points(-10, 10, -3, 3);

MapperConfig remembering(double max_age_s) {
  MapperConfig config = half_metre_map();
  config.window = {2, 1000};
  config.memory.max_age_s = max_age_s;
  config.vehicle.radius_m = 0;
  return config;
}

// Two sweeps that see nothing of the floor: the window knows no more.
void look_elsewhere(Rig& rig, std::int64_t stamp_ns) {
  rig.see(kElsewhere, stamp_ns - 1);
  rig.see(kElsewhere, stamp_ns);
}

TEST_CASE("Ground that no lidar sees any more is as it was, and says how old it is") {
  Rig rig(remembering(20)), forgetful(remembering(0));
  for (Rig* one : {&rig, &forgetful}) {
    one->see(kFloor, kBeat_ns + 5);
    look_elsewhere(*one, 4 * kBeat_ns + kBeat_ns / 4);
  }
  const ColumnValues column = rig.column(3.25, 2.25);
  CHECK(column.height == 0.05f);
  CHECK(column.slope == 0);
  CHECK(column.flags == 0);
  CHECK(column.cost == 0);
  CHECK(column.visibility == 4);
  CHECK(column.last_seen == static_cast<float>(3.25 * static_cast<double>(kBeat_ns) * 1e-9));
  CHECK(forgetful.column(3.25, 2.25).visibility == 0);
  CHECK(rig.column(0.25, 4.25).visibility == 1);  // what the window has passed is the window's
  CHECK(rig.column(0.25, 4.25).last_seen == 0);
}

TEST_CASE("Ground stays where rays only graze it, until one goes below it") {
  Rig rig(remembering(20));
  rig.see(kFloor, kBeat_ns);
  // To 0.05 m at x = 8.25 m: through the ground's voxel before that, 0.09 m up where it leaves the column.
  for (const std::int64_t later : {1, 2}) rig.see({{8.25, 0.25, 0.05}}, 3 * kBeat_ns + later);
  CHECK(rig.voxel(7.75, 0.25, 0.25).hits == 0);
  CHECK(rig.voxel(7.75, 0.25, 0.25).passes == 2);
  CHECK(rig.column(7.75, 0.25).height == 0.05f);
  CHECK(rig.column(7.75, 0.25).visibility == 4);
  CHECK(rig.column(7.75, 0.25).last_seen == Approx(2 * static_cast<double>(kBeat_ns) * 1e-9));
  rig.see({{8.25, 0.25, -0.6}}, 3 * kBeat_ns + 3);
  CHECK(std::isnan(rig.column(7.75, 0.25).height));
  CHECK(rig.column(7.75, 0.25).visibility == 1);
}

TEST_CASE("Where ground of two times meets, a slope is not steep by a drift between them") {
  // 0.4 m/m, seen again 0.2 m higher beyond y = 0: 0.6 m/m there, less an error of 0.04; 0.5 rad is 0.546
  // m/m.
  const auto hillside = [](double low_m, double slope, double drift_m) {
    return surface(1, 4, low_m, 3, [&](double, double y) { return slope * y + (y > 0 ? drift_m : 0); });
  };
  const auto flags = [&](double slope, double drift_m) {
    Rig rig(remembering(20));
    rig.see(hillside(-3, slope, 0), kBeat_ns);
    for (const std::int64_t later : {1, 2}) rig.see(hillside(0, slope, drift_m), 3 * kBeat_ns + later);
    REQUIRE(rig.column(2.25, -0.25).visibility == 4);
    REQUIRE(rig.column(2.25, 0.25).visibility == 3);
    return rig.column(2.25, 0.25).flags;
  };
  CHECK(flags(0.4, 0.2) == 0);
  CHECK(flags(0.8, 0) == kSteep);
  Rig at_once(remembering(20));
  at_once.see(hillside(-3, 0.4, 0.2), kBeat_ns);
  CHECK(at_once.column(2.25, 0.25).flags == kSteep);
}

TEST_CASE("A column through which rays only passed is remembered as that") {
  Rig rig(remembering(20));
  rig.see({{8.25, 0.25, 1.25}, {8.25, 0.25, 0.75}}, kBeat_ns);
  look_elsewhere(rig, 2 * kBeat_ns);
  CHECK(rig.column(5.25, 0.25).visibility == 4);
  CHECK(std::isnan(rig.column(5.25, 0.25).height));
  CHECK(rig.column(5.25, 0.25).last_seen == static_cast<float>(static_cast<double>(kBeat_ns) * 1e-9));
}

TEST_CASE("What a map observes again is what the window says, alone") {
  Rig rig(remembering(20));
  rig.see({{5.25, 0.25, 0.05}, {5.25, 0.25, 0.15}}, kBeat_ns);
  look_elsewhere(rig, 2 * kBeat_ns);
  CHECK(rig.voxel(5.25, 0.25, 0.25).hits == 2);
  rig.see({{5.25, 0.25, 0.35}}, 3 * kBeat_ns);
  CHECK(rig.voxel(5.25, 0.25, 0.25).hits == 1);
  CHECK(rig.column(5.25, 0.25).height == 0.35f);
  CHECK(rig.column(5.25, 0.25).visibility == 3);
}

TEST_CASE("Within a beat of the memory hits and passes add up, the newest beat counts") {
  Rig rig(remembering(20));
  rig.see({{5.25, 0.25, 0.35}}, kBeat_ns);
  rig.see({{5.25, 0.25, 0.05}}, 2 * kBeat_ns);
  rig.see({{5.25, 0.25, 0.05}, {5.25, 0.25, 0.15}}, 2 * kBeat_ns + 1);
  look_elsewhere(rig, 2 * kBeat_ns + 3);
  CHECK(rig.voxel(5.25, 0.25, 0.25).hits == 3);
  CHECK(rig.voxel(5.25, 0.25, 0.25).min_height_m == 0.05f);
  CHECK(rig.voxel(3.25, 0.25, 0.75).passes == 3);  // and then down into the voxel below
}

TEST_CASE("A walker does not come back where rays have passed since") {
  const Points walker{{5.25, 0.25, 0.75}, {5.25, 0.25, 1.25}};
  Points beyond;
  for (double z = 0.3; z < 1.4; z += 0.1) beyond.emplace_back(8.25, 0.25, z);
  Rig rig(remembering(20));
  rig.see(kFloor + walker, kBeat_ns);
  look_elsewhere(rig, 2 * kBeat_ns);
  REQUIRE(rig.voxel(5.25, 0.25, 0.75).hits == 1);  // while nothing was seen there
  REQUIRE(rig.voxel(5.25, 0.25, 1.25).hits == 1);
  rig.see(kFloor + beyond, 3 * kBeat_ns);
  look_elsewhere(rig, 4 * kBeat_ns);
  CHECK(rig.voxel(5.25, 0.25, 0.75).hits == 0);
  CHECK(rig.voxel(5.25, 0.25, 1.25).hits == 0);
  CHECK(rig.column(5.25, 0.25).height == 0.05f);
  CHECK(rig.column(5.25, 0.25).flags == 0);
}

TEST_CASE("What stood on ground that is seen is gone, though no ray passes through it") {
  const Points head{{5.25, 0.25, 1.25}, {5.25, 0.25, 1.35}};
  Rig rig(remembering(20));
  rig.see(kFloor + head, kBeat_ns);
  look_elsewhere(rig, 2 * kBeat_ns);
  CHECK(rig.column(5.25, 0.25).flags == kSoft);  // nothing is seen there
  rig.see(kFloor, 3 * kBeat_ns);
  rig.see(kFloor, 4 * kBeat_ns);
  CHECK(rig.voxel(5.25, 0.25, 1.25).hits == 2);
  CHECK(rig.column(5.25, 0.25).flags == 0);
  CHECK(rig.column(5.25, 0.25).obstacle_density == 0);
}

TEST_CASE("A ray that was somewhere in the lowest voxel seen takes no ground away") {
  Rig rig(remembering(20));
  rig.see({{5.25, 0.25, 0.05}}, kBeat_ns);
  rig.see({{5.75, 0.25, 0.05}}, 2 * kBeat_ns);  // 5 to 16 cm above that ground
  rig.see({{5.75, 0.25, 0.05}}, 3 * kBeat_ns);
  CHECK(rig.voxel(5.25, 0.25, 0.25).passes == 2);
  look_elsewhere(rig, 4 * kBeat_ns);
  CHECK(rig.voxel(5.25, 0.25, 0.25).hits == 1);
  CHECK(rig.column(5.25, 0.25).height == 0.05f);
}

TEST_CASE("After its time it is forgotten") {
  Rig rig(remembering(2.5));  // 4.66, so 5 beats
  rig.see(kFloor, 3 * kBeat_ns);
  look_elsewhere(rig, 9 * kBeat_ns - 1);
  CHECK(rig.column(3.25, 2.25).visibility == 4);
  rig.see(kElsewhere, 9 * kBeat_ns);
  CHECK(rig.column(3.25, 2.25).visibility == 0);
  CHECK(std::isnan(rig.column(3.25, 2.25).last_seen));
  CHECK(std::isnan(rig.column(3.25, 2.25).height));
}

TEST_CASE("A pause of minutes forgets everything") {
  Rig rig(remembering(2.5));
  rig.see(kFloor, 3 * kBeat_ns);
  look_elsewhere(rig, 4 * kBeat_ns);
  look_elsewhere(rig, (3 + 256) * kBeat_ns);
  CHECK(rig.column(3.25, 2.25).visibility == 0);
}

TEST_CASE("What has left the grid is forgotten") {
  Rig rig(remembering(20));
  rig.see(kFloor, kBeat_ns);
  look_elsewhere(rig, 2 * kBeat_ns);
  rig.see({{100.25, 5.25, 1.25}}, 3 * kBeat_ns, {100, 0, 0});
  look_elsewhere(rig, 4 * kBeat_ns);
  CHECK(rig.column(3.25, 2.25).visibility == 0);
}

TEST_CASE("A reset empties the memory") {
  Rig rig(remembering(20));
  rig.see(kFloor, kBeat_ns);
  look_elsewhere(rig, 2 * kBeat_ns);
  rig.reset();
  look_elsewhere(rig, 3 * kBeat_ns);
  CHECK(rig.column(3.25, 2.25).visibility == 0);
}

TEST_CASE("Ground that is seen again a voxel higher, after a drift, is not there twice") {
  Rig rig(remembering(20));
  rig.see({{5.25, 0.25, 0.45}}, kBeat_ns);
  look_elsewhere(rig, 2 * kBeat_ns);
  rig.see({{5.25, 0.25, 0.55}}, 3 * kBeat_ns);
  CHECK(rig.column(5.25, 0.25).height == 0.55f);
  CHECK(rig.column(5.25, 0.25).visibility == 3);
}

TEST_CASE("What is remembered below ground that is seen is not asked, but under what hangs it is") {
  const Points low{{5.25, 0.25, -1.25}}, high{{5.25, 0.25, 0.75}};
  Rig rig(remembering(20)), over_crown(remembering(20));
  for (Rig* one : {&rig, &over_crown}) {
    one->see(low, kBeat_ns);
    look_elsewhere(*one, 2 * kBeat_ns);
    CHECK(one->column(5.25, 0.25).height == -1.25f);
  }
  rig.see(high, 3 * kBeat_ns);
  CHECK(rig.column(5.25, 0.25).height == 0.75f);
  CHECK(rig.column(5.25, 0.25).visibility == 3);
  over_crown.see(high + Points{{6.25, 0.25, -0.25}}, 3 * kBeat_ns);  // 1 m below it where it leaves
  CHECK(over_crown.column(5.25, 0.25).height == -1.25f);
  CHECK(over_crown.column(5.25, 0.25).visibility == 4);
}

TEST_CASE("The ditch before the vehicle stays while rays go over it only") {
  Points far_wall, over;
  for (double y = -2.75; y < 3; y += 0.5) {
    for (const double z : {-0.3, -0.6, -0.9}) far_wall.emplace_back(8.1, y, z);
    over.emplace_back(11.25, y, 0.35);
  }
  const Points near_side = floor_points(-2, 6, -3, 3), far_side = floor_points(8, 14, -3, 3);
  Rig rig(remembering(20)), forgetful(remembering(0));
  for (Rig* one : {&rig, &forgetful}) {
    one->see(near_side + far_side + far_wall, kBeat_ns);
    REQUIRE((one->column(7.75, 0.25).flags & kNegative) != 0);
    for (int i = 2; i < 6; ++i) one->see(near_side + over, i * kBeat_ns);
  }
  CHECK((rig.column(7.75, 0.25).flags & kNegative) != 0);
  CHECK((forgetful.column(7.75, 0.25).flags & kNegative) == 0);
}

TEST_CASE("The order of maps changes nothing of what is remembered") {
  MapperConfig config = remembering(20);
  config.window.buffer_size = 3;
  Rig in_order(config), late(config);
  const Points post{{5.25, 0.25, 1.05}, {5.25, 0.25, 0.75}};
  const std::vector<Points> seen{kFloor, post, kFloor + post, kElsewhere, kElsewhere, kElsewhere};
  const auto see = [&](Rig& rig, int i) {
    REQUIRE(rig.see(seen[std::size_t(i)], (i + 10) * kBeat_ns / 4) == AddResult::added);
  };
  for (const int i : {0, 1, 2, 3, 4, 5}) see(in_order, i);
  for (const int i : {0, 2, 1, 3, 5, 4}) see(late, i);
  for (double x = -9.75; x < 12; x += 0.5)
    for (double y = -4.75; y < 5; y += 0.5) {
      const ColumnValues one = in_order.column(x, y), other = late.column(x, y);
      REQUIRE((one.height == other.height || (std::isnan(one.height) && std::isnan(other.height))));
      REQUIRE(one.cost == other.cost);
      REQUIRE(one.visibility == other.visibility);
    }
  CHECK(in_order.total().hits == late.total().hits);
  CHECK(in_order.total().passes == late.total().passes);
}

}  // namespace
}  // namespace gvom::test
