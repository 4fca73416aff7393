// A simulated recording is a function of its seed, and decodes to the world that it was cast from.
#include <cmath>
#include <fstream>
#include <iterator>

#include <catch2/catch.hpp>

#include "services/common/odometry_file.hpp"
#include "services/ingest/source.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/sim/scenes/trail.hpp"
#include "tools/sim/simulate.hpp"

using namespace gvom::sim;
using gvom::services::VehicleConfig;
using gvom::test::TemporaryFolder;

namespace {

constexpr double kCentimetre = 0.01;

VehicleConfig two_lidars() {
  VehicleConfig vehicle;
  vehicle.lidars.resize(2);
  vehicle.lidars[0].name = "front";
  vehicle.lidars[0].geometry.T_base_sensor =
      Eigen::Translation3d(0.45, 0.0, 0.95) * Eigen::AngleAxisd(0.10, Eigen::Vector3d::UnitY());
  vehicle.lidars[1].name = "rear";
  vehicle.lidars[1].geometry.T_base_sensor =
      Eigen::Translation3d(-0.45, 0.1, 1.05) * Eigen::AngleAxisd(3.05, Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(0.12, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitX());
  return vehicle;
}

RecordingOptions short_drive() {
  RecordingOptions options;
  options.seconds = 0.2;
  options.threads = 2;
  return options;
}

const World& trail() {
  static const World world(make_trail({1, path_length_m(two_lidars(), short_drive()), 5.0}));
  return world;
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// All bytes of a recording and its truth.
std::string record(const RecordingOptions& options) {
  const TemporaryFolder folder;
  REQUIRE(simulate(two_lidars(), trail(), options, folder.path()));
  std::string all;
  for (const char* name : {"front.pcap", "front.json", "rear.pcap", "rear.json", "odometry.tum", "truth.json",
                           "class.npy", "ground_lowest.npy", "object.npy", "clearance.npy"}) {
    const std::string bytes = read_file(folder.path() + "/" + name);
    CHECK_FALSE(bytes.empty());
    all += bytes;
  }
  return all;
}

bool contains(Body body, const Eigen::Vector3d& point, double grown_by) {
  if (body.shape != Body::Shape::capsule) body.size.array() += grown_by;
  body.radius_m += grown_by;
  const Interval inside = intersect(Primitive(body, 0), {point, Eigen::Vector3d::UnitZ()});
  return inside.enter <= 0.0 && inside.leave >= 0.0;
}

bool is_on(const Primitive& primitive, const Eigen::Vector3d& point) {
  return contains(primitive.body, point, kCentimetre) &&
         !(primitive.is_solid() && contains(primitive.body, point, -kCentimetre));
}

bool is_on_ground(const Terrain& terrain, const Eigen::Vector3d& point) {
  const double height = terrain.height_m(point.x(), point.y());
  const double step = 0.004;
  const double slope = std::max(std::abs(terrain.height_m(point.x() + step, point.y()) - height),
                                std::abs(terrain.height_m(point.x() - step, point.y()) - height)) /
                       step;
  const double slope_y = std::max(std::abs(terrain.height_m(point.x(), point.y() + step) - height),
                                  std::abs(terrain.height_m(point.x(), point.y() - step) - height)) /
                         step;
  return std::abs(point.z() - height) < kCentimetre * std::sqrt(1.0 + slope * slope + slope_y * slope_y);
}

bool is_on_something(const World& world, double time_s, const Eigen::Vector3d& point) {
  if (is_on_ground(world.terrain(), point) || is_on(world.walkers_at(time_s).front(), point)) return true;
  for (const Primitive& body : world.primitives())
    if (is_on(body, point)) return true;
  return false;
}

}  // namespace

TEST_CASE("the same seed gives the same bytes, on one thread and on three; another seed gives others") {
  RecordingOptions options = short_drive();
  options.odometry_noise = {0.02, 0.001};
  const std::string first = record(options);
  options.threads = 3;
  CHECK(record(options) == first);
  options.sweep.seed = 2;
  CHECK(record(options) != first);
}

TEST_CASE("odometry covers every column and follows the drive") {
  const TemporaryFolder folder;
  const RecordingOptions options = short_drive();
  REQUIRE(simulate(two_lidars(), trail(), options, folder.path()));
  std::vector<std::string> warnings;
  const auto poses = gvom::services::read_odometry_source("tum:" + folder.path() + "/odometry.tum", warnings);
  REQUIRE(poses);
  CHECK(warnings.empty());
  const std::vector<LidarModel> lidars = make_lidars(two_lidars(), options);
  CHECK(poses->front().stamp_ns < lidars[0].stamp_ns(0, 0));
  CHECK(poses->back().stamp_ns > lidars[1].stamp_ns(1, lidars[1].columns - 1));
  const double driven =
      (poses->back().T_odom_base.translation_m - poses->front().T_odom_base.translation_m).norm();
  const double seconds = 1e-9 * static_cast<double>(poses->back().stamp_ns - poses->front().stamp_ns);
  CHECK(driven == Approx(5.0 * seconds).epsilon(0.01));
}

TEST_CASE("without noise every decoded return lies on something, to a centimetre") {
  const TemporaryFolder folder;
  RecordingOptions options = short_drive();
  options.sweep.range_noise_m = 0.0;
  const VehicleConfig vehicle = two_lidars();
  const World& world = trail();
  REQUIRE(simulate(vehicle, world, options, folder.path()));
  const Trajectory trajectory(world.terrain(), world.data().path_m, {options.speed_mps, 0.0});
  for (const auto& lidar : vehicle.lidars) {
    const std::string stem = folder.path() + "/" + lidar.name;
    const auto source = gvom::ingest::open_source("ouster:" + stem + ".pcap?meta=" + stem + ".json", {});
    REQUIRE(source);
    CHECK((*source)->warnings().empty());
    gvom::Sweep sweep;
    int sweeps = 0;
    while ((*source)->next(sweep, std::chrono::milliseconds(0)).value() ==
           gvom::ingest::SourceEvent::kSweep) {
      ++sweeps;
      CHECK(sweep.complete);
      CHECK(sweep.returns.size() > 20'000);
      std::size_t adrift = 0;
      for (std::size_t i = 0; i < sweep.returns.size(); i += 5) {
        const gvom::Return& point = sweep.returns[i];
        const double time_s = 1e-9 * static_cast<double>(sweep.times_ns[point.time_index] - kStartNs);
        const gvom::Pose base = trajectory.at(time_s);
        const Eigen::Vector3d in_base =
            lidar.geometry.T_base_sensor * Eigen::Vector3d(point.x_m, point.y_m, point.z_m);
        adrift += !is_on_something(world, time_s, base.rotation * in_base + base.translation_m);
      }
      CHECK(adrift == 0);
    }
    CHECK(sweeps == 2);
    CHECK((*source)->counters().packets == 2 * 64);
    CHECK((*source)->counters().foreign_packets == 0);
  }
}

TEST_CASE("a drive that is longer than its path ends with the path") {
  const TemporaryFolder folder;
  RecordingOptions options = short_drive();
  options.seconds = 60.0;
  options.speed_mps = 10.0;
  WorldData data = make_trail({1, 4.0, 5.0});
  data.path_m = {{0.0, 0.0}, {4.0, 0.0}};
  const World world(std::move(data));
  const auto made = simulate(two_lidars(), world, options, folder.path());
  REQUIRE(made);
  CHECK(made->sweeps == 3);  // 0.4 s, the second lidar 37 ms later
  CHECK(made->driven_m == Approx(4.0));
}
