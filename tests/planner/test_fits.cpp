#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "services/planner/costmap.hpp"
#include "tests/planner/flat_map.hpp"

namespace gvom::test {
namespace {

using planner::Costmap;
using planner::CostmapConfig;
using planner::Pose2;
using planner::VehicleLimits;

constexpr double kPi = 3.14159265358979323846;

TEST_CASE("A vehicle of 1.4 m passes between trunks that stand 3 m apart, not between those 1.6 m apart") {
  for (const double yaw_rad : {-0.15, 0.0, 0.15}) {
    for (const int apart : {4, 7}) {
      FlatMap map(40);
      map.flag(20, 10, 20, 10, kHard);
      map.flag(20, 10 + apart, 20, 10 + apart, kHard);
      Costmap costmap(CostmapConfig{}, VehicleLimits{}, map.n);
      costmap.update(map.view());
      const Eigen::Vector2d between = (map.middle_m(20, 10) + map.middle_m(20, 10 + apart)) / 2;
      CHECK(costmap.fits({between.x(), between.y(), yaw_rad}) == (apart == 7));
    }
  }
}

TEST_CASE("The vehicle and its margin end where they are said to") {
  FlatMap map(40);
  map.flag(20, 20, 20, 20, kHard);
  VehicleLimits vehicle;
  vehicle.front_m = 2;
  vehicle.rear_m = 0.5;
  Costmap costmap(CostmapConfig{}, vehicle, map.n);
  costmap.update(map.view());
  const Eigen::Vector2d trunk = map.middle_m(20, 20);
  const auto fits = [&](double ahead_m, double left_m, double yaw_rad) {
    const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
    return costmap.fits(
        {trunk.x() - c * ahead_m + s * left_m, trunk.y() - s * ahead_m - c * left_m, yaw_rad});
  };
  for (double yaw_rad = -3; yaw_rad < 3; yaw_rad += 0.37) {
    INFO("heading " << yaw_rad);
    CHECK(fits(2.21, 0, yaw_rad));
    CHECK_FALSE(fits(2.19, 0, yaw_rad));
    CHECK_FALSE(fits(2.19, 0.89, yaw_rad));
    CHECK(fits(-0.71, 0, yaw_rad));
    CHECK_FALSE(fits(-0.69, -0.89, yaw_rad));
    CHECK(fits(1, 0.91, yaw_rad));
    CHECK_FALSE(fits(1, -0.89, yaw_rad));
  }
}

// Whether any lethal cell's middle is in the rectangle, all cells tried.
bool slow_fits(const FlatMap& map, const Costmap& costmap, const VehicleLimits& vehicle, double margin_m,
               const Pose2& pose) {
  for (int i = 0; i < map.n * map.n; ++i) {
    if (!costmap.lethal()[i]) continue;
    const Eigen::Vector2d off = map.middle_m(i % map.n, i / map.n) - Eigen::Vector2d(pose.x_m, pose.y_m);
    const Eigen::Vector2d seen = Eigen::Rotation2Dd(-pose.yaw_rad) * off;
    if (seen.x() <= vehicle.front_m + margin_m && seen.x() >= -vehicle.rear_m - margin_m &&
        std::fabs(seen.y()) <= vehicle.width_m / 2 + margin_m)
      return false;
  }
  return true;
}

TEST_CASE("Whether it fits is what trying all cells says, on random maps, beyond their border too") {
  int fitting = 0, poses = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const FlatMap map = random_map(random, 32, 0.01);
    VehicleLimits vehicle;
    vehicle.front_m = random.uniform(0.3, 4);
    vehicle.rear_m = random.uniform(0.3, 1.5);
    vehicle.width_m = random.uniform(0.4, 2.4);
    const CostmapConfig config;
    Costmap costmap(config, vehicle, map.n);
    costmap.update(map.view());
    for (int k = 0; k < 300; ++k) {
      const Pose2 pose{random.uniform(-4, 16), random.uniform(-4, 16), random.uniform(-kPi, kPi)};
      INFO("seed " << seed << ", pose " << k);
      const bool expected = slow_fits(map, costmap, vehicle, config.margin_m, pose);
      REQUIRE(costmap.fits(pose) == expected);
      fitting += expected;
      ++poses;
    }
  }
  CHECK(fitting > poses / 10);
  CHECK(fitting < poses * 9 / 10);
}

}  // namespace
}  // namespace gvom::test
