// What the product decodes from the simulated packets is what was measured, for each sensor; weak returns get
// lost.
#include <cmath>

#include <catch2/catch.hpp>

#include "services/ingest/source.hpp"
#include "tests/tools/sim_worlds.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/sim/materials.hpp"
#include "tools/sim/simulate.hpp"

using namespace gvom::sim;
using namespace gvom::test;
using gvom::services::VehicleConfig;

namespace {

VehicleConfig one_lidar() {
  VehicleConfig vehicle;
  vehicle.lidars.resize(1);
  vehicle.lidars[0].name = "top";
  vehicle.lidars[0].geometry.T_base_sensor =
      Eigen::Translation3d(0.2, 0.1, 1.7) * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY());
  return vehicle;
}

WorldData posts_world() {
  WorldData data = level_world();
  for (int i = 0; i < 20; ++i) add(data, Kind::tree, post(3.0 * i, i % 2 == 0 ? 4.0 : -6.0, 0.2, 5.0));
  add(data, Kind::bush, ball({8.0, -3.0, 0.5}, 1.0), 1.5, kThinBush);
  return data;
}

LidarModel lidar_of(Sensor sensor) {
  RecordingOptions options;
  options.sensor = sensor;
  return make_lidars(one_lidar(), options).front();
}

void check_decoded(Sensor sensor, const std::string& scheme, const std::string& query) {
  const TemporaryFolder folder;
  RecordingOptions options;
  options.seconds = 0.3;
  options.sensor = sensor;
  const World world(posts_world());
  REQUIRE(simulate(one_lidar(), world, options, folder.path()));
  const Trajectory trajectory(world.terrain(), world.data().path_m, {options.speed_mps, 0.0});
  const LidarModel lidar = make_lidars(one_lidar(), options).front();
  const SweepSimulator simulator(world, trajectory, lidar, options.sweep);

  const auto source =
      gvom::ingest::open_source(scheme + ":" + folder.path() + "/top.pcap?" + query +
                                    (sensor == Sensor::vlp_16 ? "" : folder.path() + "/top.json"),
                                {});
  REQUIRE(source);
  gvom::Sweep decoded, measured;
  int sweeps = 0;
  while ((*source)->next(decoded, std::chrono::milliseconds(0)).value() ==
         gvom::ingest::SourceEvent::kSweep) {
    simulator.measure(sweeps++, measured);
    CHECK(decoded.complete);
    CHECK(decoded.stamp_ns == measured.stamp_ns);
    CHECK(decoded.times_ns == measured.times_ns);
    REQUIRE(decoded.returns.size() == measured.returns.size());
    CHECK(decoded.returns.size() > static_cast<std::size_t>(lidar.columns) * lidar.beams() / 5);
    double farthest = 0.0;
    for (std::size_t i = 0; i < decoded.returns.size(); ++i) {
      const gvom::Return &a = decoded.returns[i], &b = measured.returns[i];
      farthest = std::max(
          farthest, (Eigen::Vector3d(a.x_m, a.y_m, a.z_m) - Eigen::Vector3d(b.x_m, b.y_m, b.z_m)).norm());
      REQUIRE(a.time_index == b.time_index);
    }
    CHECK(farthest < 1e-9);
  }
  CHECK(sweeps == 3);
  CHECK((*source)->warnings().empty());
  CHECK((*source)->counters().foreign_packets == 0);
}

}  // namespace

TEST_CASE("what the product decodes from an OS1-64's packets is what was measured") {
  check_decoded(Sensor::os1_64, "ouster", "meta=");
}

TEST_CASE("what the product decodes from an OS1-128's packets is what was measured") {
  check_decoded(Sensor::os1_128, "ouster", "meta=");
}

TEST_CASE("what the product decodes from a VLP-16's packets is what was measured") {
  check_decoded(Sensor::vlp_16, "velodyne", "model=VLP-16");
}

TEST_CASE("sensors have the beams of their data sheets") {
  const LidarModel os64 = lidar_of(Sensor::os1_64), os128 = lidar_of(Sensor::os1_128);
  const LidarModel puck = lidar_of(Sensor::vlp_16);
  CHECK(os64.beams() == 64);
  CHECK(os128.beams() == 128);
  CHECK(puck.beams() == 16);
  CHECK(os64.altitude_deg.front() - os64.altitude_deg.back() == Approx(45.0).margin(0.07));
  CHECK(os128.altitude_deg[10] - os128.altitude_deg[11] == Approx(45.0 / 127.0).margin(0.07));
  CHECK(puck.altitude_deg.front() == -15.0);
  CHECK(puck.altitude_deg.back() == 15.0);
  CHECK(puck.turn_ns == 1800 * 55'296);
  CHECK(find_sensor("os1-128").value() == Sensor::os1_128);
  CHECK(find_sensor("os2").error() == "os2: no such sensor; there are os1-64, os1-128 and vlp-16");
}

TEST_CASE("of 10 % targets square to the beam 90 % are seen at 35 m, 80 % at 37 m, half at 42 m") {
  const SensorLosses losses;
  CHECK(chance_of({35.0, 1.0, 10}, losses) == Approx(0.90).margin(0.01));
  CHECK(chance_of({37.4, 1.0, 10}, losses) == Approx(0.80).margin(0.01));
  CHECK(chance_of({42.0, 1.0, 10}, losses) == Approx(0.50));
  CHECK(chance_of({42.0 * 2.0, 1.0, 40}, losses) == Approx(0.50));  // the square of the range
  CHECK(chance_of({20.0, 0.0, 30}, losses) > 0.9);                  // grazing
  CHECK(chance_of({60.0, 0.0, 30}, losses) < 0.1);
  SensorLosses none;
  none.enabled = false;
  CHECK(chance_of({90.0, 0.0, 1}, none) == 1.0);
}

TEST_CASE("level ground is seen near and lost far out, all of it where nothing is lost") {
  WorldData data = level_world();
  data.path_m = {{0.0, 0.0}, {5.0, 0.0}};
  const World world(std::move(data));
  const Trajectory trajectory(world.terrain(), world.data().path_m, {1.0, 0.0});
  const LidarModel lidar = lidar_of(Sensor::os1_128);
  const auto counts = [&](bool enabled) {
    SweepOptions options;
    options.losses.enabled = enabled;
    gvom::Sweep sweep;
    SweepSimulator(world, trajectory, lidar, options).measure(0, sweep);
    std::array<int, 2> near_and_far{};
    for (const gvom::Return& point : sweep.returns) {
      const double range = std::hypot(point.x_m, point.y_m);
      if (range < 20.0) ++near_and_far[0];
      if (range > 60.0) ++near_and_far[1];
    }
    return near_and_far;
  };
  const auto with = counts(true), without = counts(false);
  CHECK(with[0] > 0.99 * without[0]);
  CHECK(without[1] > 50);
  CHECK(with[1] < 0.1 * without[1]);
}

TEST_CASE("a sweep is a function of its number alone") {
  const World world(posts_world());
  const Trajectory trajectory(world.terrain(), world.data().path_m, {5.0, 0.0});
  const LidarModel lidar = lidar_of(Sensor::os1_64);
  const SweepSimulator simulator(world, trajectory, lidar, {});
  gvom::Sweep first, other, again;
  simulator.measure(3, first);
  simulator.measure(4, other);
  simulator.measure(3, again);
  CHECK(first.times_ns == again.times_ns);
  CHECK(first.returns.size() == again.returns.size());
  CHECK(first.returns[1000].x_m == again.returns[1000].x_m);
  CHECK(first.returns[1000].x_m != other.returns[1000].x_m);
}
