// What the wheels stand on, in computed answers.
#include <catch2/catch.hpp>

#include "services/planner/stance.hpp"
#include "tests/planner_cycle/small_map.hpp"

namespace gvom::test {
namespace {

using planner::is_bad;
using planner::Pose2;
using planner::Stance;
using planner::stance_at;
using planner::VehicleLimits;

constexpr double kPi = 3.14159265358979323846;

TEST_CASE("On a tilted plane it pitches when it faces the slope and rolls when it drives across") {
  SmallMap map(64);
  map.shape([](double x, double) { return 1 + 0.2 * x; });
  const VehicleLimits vehicle;
  const double tilt_rad = std::atan(0.2);

  const Stance up = stance_at(map.view(), vehicle, {10, 10, 0});
  REQUIRE(up.known);
  CHECK(up.z_m == Approx(3.0));
  CHECK(up.pitch_rad == Approx(-tilt_rad));  // nose up
  CHECK(up.roll_rad == Approx(0).margin(1e-5));
  CHECK(up.belly_m == Approx(0).margin(1e-5));

  const Stance across = stance_at(map.view(), vehicle, {10, 10, kPi / 2});
  CHECK(across.pitch_rad == Approx(0).margin(1e-5));
  CHECK(across.roll_rad == Approx(-tilt_rad));  // its left is downhill

  // Half of the slope along each axis: roll is measured about the pitched axis.
  const Stance between = stance_at(map.view(), vehicle, {10, 10, kPi / 4});
  const double half = 0.2 / std::sqrt(2.0);
  CHECK(between.pitch_rad == Approx(-std::atan(half)));
  CHECK(std::sin(between.roll_rad) == Approx(-half / std::sqrt(1 + 0.2 * 0.2)));
}

TEST_CASE("base_link at the rear axle is where the plane is measured") {
  SmallMap map(64);
  map.shape([](double x, double) { return 0.1 * x; });
  VehicleLimits car;
  car.front_axle_m = 2.0;
  car.rear_axle_m = 0.0;
  CHECK(stance_at(map.view(), car, {10, 10, 0}).z_m == Approx(1.0));
  CHECK(stance_at(map.view(), car, {10, 10, 0}).pitch_rad == Approx(-std::atan(0.1)));
}

TEST_CASE("With both left wheels in a rut it rolls by the rut's depth over its track") {
  SmallMap map(64);
  map.shape([](double, double y) { return y > 10.0 && y < 10.8 ? -0.2 : 0.0; });
  const VehicleLimits vehicle;  // wheels at y = 10.55 and 9.45
  const Stance stance = stance_at(map.view(), vehicle, {10, 10, 0});
  REQUIRE(stance.known);
  CHECK(stance.roll_rad == Approx(-std::atan(0.2 / 1.1)));
  CHECK(stance.pitch_rad == Approx(0).margin(1e-6));
  // The highest ground between the wheels is at 0, 0.2 m right of its middle, where the plane is as low as
  // this.
  CHECK(stance.belly_m == Approx(0.1 - 0.2 * 0.2 / 1.1));
}

TEST_CASE("A rock between the wheels is bad where it is higher than the ground clearance") {
  const VehicleLimits vehicle;
  for (const double rock_m : {0.2, 0.3}) {
    SmallMap map(64);
    map.where(box(10.0, 10.0, 10.4, 10.4),
              [&](std::size_t i) { map.height[i] = static_cast<float>(rock_m); });
    const Stance stance = stance_at(map.view(), vehicle, {10.2, 10.2, 0});
    REQUIRE(stance.known);
    CHECK(stance.belly_m == Approx(rock_m));
    CHECK(is_bad(stance, vehicle) == (rock_m > 0.25));
    CHECK(stance_at(map.view(), vehicle, {10.2, 12.2, 0}).belly_m == 0);
  }
}

TEST_CASE("With a wheel over unknown ground nothing is said, and nothing is bad") {
  SmallMap map(64);
  map.shape([](double x, double) { return 0.9 * x; });
  CHECK(is_bad(stance_at(map.view(), {}, {10, 10, 0}), {}));
  map.hide(disc(10.5, 10.55, 0.3));
  const Stance stance = stance_at(map.view(), {}, {10, 10, 0});
  CHECK_FALSE(stance.known);
  CHECK_FALSE(is_bad(stance, {}));
  CHECK_FALSE(stance_at(map.view(), {}, {100, 10, 0}).known);
}

TEST_CASE("Roll and pitch are bad beyond their limits, either way") {
  const VehicleLimits vehicle;  // 0.40 and 0.50
  for (const double side : {-1.0, 1.0}) {
    CHECK_FALSE(is_bad({true, 0, side * 0.39, 0, 0}, vehicle));
    CHECK(is_bad({true, 0, side * 0.41, 0, 0}, vehicle));
    CHECK_FALSE(is_bad({true, 0, 0, side * 0.49, 0}, vehicle));
    CHECK(is_bad({true, 0, 0, side * 0.51, 0}, vehicle));
  }
}

}  // namespace
}  // namespace gvom::test
