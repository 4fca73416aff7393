// The loop in lock-step: what is seen is true, commands come when they can, and the same seed drives the
// same.
#include <cmath>
#include <cstring>

#include <catch2/catch.hpp>

#include "tests/drive/driven.hpp"
#include "tests/drive/pursuit.hpp"

using namespace gvom;
using namespace gvom::driving;
using namespace gvom::test;

namespace {

sim::WorldData small_wood() {
  sim::WorldData data = level_world();
  add(data, sim::Kind::tree, post(6, 2.5, 0.2, 4));
  add(data, sim::Kind::tree, post(9, -2, 0.2, 4));
  add(data, sim::Kind::rock, ball({12, 2, 0}, 0.8));
  return data;
}

Rig rig_of(int lidars) {
  Rig rig;
  rig.model = small_vehicle(planner::Steering::skid_steer);
  rig.mapping.mapper.vehicle.base_height_m = rig.model.base_height_m;
  for (int i = 0; i < lidars; ++i) {
    LidarGeometry geometry;
    geometry.T_base_sensor.translation() = Eigen::Vector3d(0.5 - i, 0, 1.6);
    rig.mapping.lidars.push_back(geometry);
  }
  return rig;
}

/// One world with its truth, for all tests.
struct Stage {
  sim::World world{small_wood()};
  sim::GroundTruth truth = sim::sample_truth(world, {0.2});
  TrueObstacles obstacles{world, truth};
};

const Stage& stage() {
  static const Stage the_stage;
  return the_stage;
}

DriveLog drive_through(int lidars, const LoopOptions& options, const Driver& driver, double seconds) {
  Loop loop(stage().world, stage().obstacles, rig_of(lidars), {}, options);
  const auto log = drive(loop, driver, seconds);
  REQUIRE(log);
  return *log;
}

/// A driver's layers, as one number.
std::uint64_t mixed_with(std::uint64_t sum, const Seen& seen) {
  const int columns = seen.grid.size[0] * seen.grid.size[1];
  for (int i = 0; i < columns; ++i) {
    std::uint32_t height = 0;
    std::memcpy(&height, seen.layers.height + i, sizeof height);
    sum = sim::mix(sum ^ height ^ (static_cast<std::uint64_t>(seen.layers.flags[i]) << 32));
  }
  return sum;
}

struct Traced {
  DriveLog log;
  std::uint64_t layers = 0;
};

Traced trace(const LoopOptions& options) {
  Traced traced;
  Pursuit pursuit({{0, 0}, {8, 0}, {20, 1}}, 3);
  traced.log = drive_through(
      2, options,
      [&](const Seen& seen) {
        traced.layers = mixed_with(traced.layers, seen);
        return pursuit(seen);
      },
      3);
  return traced;
}

}  // namespace

TEST_CASE(
    "the same seed drives the same way and sees the same, whatever the threads; another seed does not") {
  LoopOptions options;
  options.odometry_noise = {0.03, 0.002};
  const Traced once = trace(options);
  options.threads = 2;
  const Traced again = trace(options);
  options.seed = 2;
  const Traced other = trace(options);
  REQUIRE(once.log.steps.size() == 30);
  REQUIRE(again.log.steps.size() == 30);
  for (std::size_t i = 0; i < 30; ++i) {
    CHECK(once.log.steps[i].T_odom_base.translation_m == again.log.steps[i].T_odom_base.translation_m);
    CHECK(once.log.steps[i].command->curvature_per_m == again.log.steps[i].command->curvature_per_m);
  }
  CHECK(once.layers == again.layers);
  CHECK(once.layers != other.layers);
  CHECK(once.log.steps.back().place.x_m > 3);
}

TEST_CASE("a command comes with the latency of mapping, then through the vehicle's delay") {
  LoopOptions options;
  options.mapping_s = 0.2;
  const DriveLog log = drive_through(
      1, options,
      [](const Seen&) {
        return Decision{planner::Command{3, 0}, false};
      },
      1);
  // The first turn ends at 0.1 s; 0.2 s of mapping and 0.1 s of delay later the vehicle begins to move.
  REQUIRE(log.steps.size() == 10);
  CHECK(log.steps[3].time_s == Approx(0.4));
  CHECK(log.steps[3].speed_mps == 0);
  CHECK(log.steps[4].speed_mps > 0.1);
  for (const DriveStep& step : log.steps) CHECK(step.layers_age_s == Approx(0.2).margin(0.002));
}

TEST_CASE("layers are of the world around the vehicle, and odometry without noise is true") {
  int looks = 0, known = 0;
  const DriveLog log = drive_through(
      1, {},
      [&](const Seen& seen) {
        const planner::MapView map = planner::map_view(seen.layers, seen.grid, seen.stamp_ns);
        const int here = map.cells().index_of(seen.state.T_odom_base.translation_m.x() + 6, 0);
        REQUIRE(here >= 0);
        if (std::isfinite(map.height[here])) CHECK(map.height[here] == Approx(0).margin(0.05));
        known += std::isfinite(map.height[here]) ? 1 : 0;
        CHECK((map.flags[here] & kHard) == 0);
        const int trunk = map.cells().index_of(5.85, 2.35);  // its side towards the vehicle
        if (looks++ > 3) CHECK((map.flags[trunk] & kHard) != 0);
        return Decision{planner::Command{2, 0}, false};
      },
      1.5);
  CHECK(looks == 15);
  CHECK(known >= 8);
  CHECK(log.driven_m == Approx(log.steps.back().place.x_m).margin(1e-6));
  // The trunk's nearer side is at y = 2.3 m, the vehicle's at 0.7 m, the tree ahead of its bumper.
  const planner::Pose2& place = log.steps.back().place;
  CHECK(log.nearest_m == Approx(std::hypot(6 - place.x_m - 0.8, 2.5 - 0.7) - 0.2).margin(0.2));
}

TEST_CASE("odometry is off by its noise, the vehicle is not") {
  LoopOptions options;
  options.odometry_noise = {0.05, 0};
  double squares = 0;
  const DriveLog log = drive_through(
      1, options,
      [&](const Seen& seen) {
        squares += std::pow(seen.state.T_odom_base.translation_m.y(), 2);
        return Decision{planner::Command{1, 0}, false};
      },
      2);
  CHECK(std::sqrt(squares / 20) > 0.005);
  CHECK(std::sqrt(squares / 20) < 0.2);
  for (const DriveStep& step : log.steps) CHECK(step.place.y_m == 0);
}

TEST_CASE("speed and curvature are the odometry's, with its noise") {
  double largest_mps = 0, last_mps = 0, last_per_m = 0;
  const auto stand = [&](const Seen& seen) {
    largest_mps = std::max(largest_mps, std::abs(seen.state.speed_mps));
    return Decision{planner::Command{0, 0}, false};
  };
  LoopOptions options;
  drive_through(1, options, stand, 1);
  CHECK(largest_mps == 0);
  // Errors of 5 cm with a memory of 1 s differ by 5 cm sqrt(2 (1 - exp(-0.15))) = 2.6 cm in 0.15 s: 0.18 m/s.
  options.odometry_noise = {0.05, 0};
  const DriveLog stood = drive_through(1, options, stand, 2);
  CHECK(largest_mps > 0.1);
  CHECK(largest_mps < 0.8);
  for (const DriveStep& step : stood.steps) CHECK(step.speed_mps == 0);

  const DriveLog turned = drive_through(
      1, {},
      [&](const Seen& seen) {
        last_mps = seen.state.speed_mps;
        last_per_m = seen.state.curvature_per_m;
        return Decision{planner::Command{1, 0.3}, false};
      },
      2.5);
  CHECK(last_mps == Approx(turned.steps.back().speed_mps).margin(0.02));
  // A skid-steer vehicle loses 10 % of its yaw rate.
  CHECK(last_per_m == Approx(0.9 * 0.3).margin(0.01));
}

TEST_CASE("a drive ends with a mishap, and by the driver") {
  const DriveLog hit = drive_through(1, {}, Pursuit({{0, 0}, {12, 2}, {20, 2}}, 4), 10);
  REQUIRE(hit.mishap);
  CHECK(hit.mishap->against == sim::ObjectClass::rock);
  CHECK(hit.nearest_m == 0);
  CHECK(hit.seconds() < 6);
  const DriveLog done = drive_through(1, {}, Pursuit({{0, 0}, {4, 0}}, 3), 10);
  CHECK(done.is_done);
  CHECK_FALSE(done.mishap);
  CHECK(done.steps.back().place.x_m == Approx(4).margin(0.6));
}

TEST_CASE("a silent driver is a vehicle that stops") {
  int turns = 0;
  const DriveLog log = drive_through(
      1, {},
      [&](const Seen&) {
        return ++turns <= 10 ? Decision{planner::Command{3, 0}, false} : Decision{};
      },
      3.5);
  CHECK(log.steps[14].speed_mps > 1);
  CHECK(log.steps.back().speed_mps == 0);
  CHECK_FALSE(log.steps.back().command);
}
