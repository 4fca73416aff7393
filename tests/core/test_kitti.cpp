// A street that a real lidar saw: the fast back end and the oracle give one map.
#include <catch2/catch.hpp>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include "core/brick_map_storage.hpp"
#include "core/mapper.hpp"
#include "tests/core/compare.hpp"
#include "tests/support/recordings.hpp"

namespace gvom::test {
namespace {

constexpr int kSweeps = 3;
constexpr int kFirstFrame = 90;
constexpr std::size_t kMaxReturns = 200'000;

std::optional<std::string> kitti_folder() {
  const auto data = recordings();
  if (!data) return std::nullopt;
  return *data + "/kitti_drive0005";
}

std::vector<StampedPose> read_odometry(const std::string& file) {
  std::vector<StampedPose> poses;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    double t_s = 0;
    StampedPose pose;
    auto& [translation_m, rotation] = pose.T_odom_base;
    words >> t_s >> translation_m.x() >> translation_m.y() >> translation_m.z();
    words >> rotation.x() >> rotation.y() >> rotation.z() >> rotation.w();
    pose.stamp_ns = std::llround(t_s * 1e9);
    poses.push_back(pose);
  }
  return poses;
}

// Frame 90 was measured 9 s from the start, and one every tenth of a second after.
Sweep read_sweep(const std::string& folder, int frame) {
  std::ifstream in(folder + "/velodyne/00000000" + std::to_string(frame) + ".bin", std::ios::binary);
  Sweep sweep;
  sweep.stamp_ns = frame * std::int64_t{100'000'000};
  sweep.times_ns = {sweep.stamp_ns};
  for (float xyzi[4]; in.read(reinterpret_cast<char*>(xyzi), sizeof xyzi);)
    sweep.returns.push_back({double{xyzi[0]}, double{xyzi[1]}, double{xyzi[2]}, 0});
  return sweep;
}

LidarGeometry roof_lidar() {
  LidarGeometry lidar;
  lidar.T_base_sensor.translation() = Eigen::Vector3d(0, 0, 1.73);
  lidar.max_range_m = 120;
  return lidar;
}

TEST_CASE("Three sweeps of a street give the oracle's bits") {
  const auto folder = kitti_folder();
  if (!folder) return;
  MapperConfig config;  // the paper's grid
  config.window.buffer_size = 2;
  const std::vector<StampedPose> poses = read_odometry(*folder + "/odometry.tum");
  REQUIRE(poses.size() > 100);
  OdometryBuffer odometry(poses.size());
  for (const StampedPose& pose : poses) REQUIRE(odometry.add(pose) == OdometryBuffer::Add::added);
  SweepMapper mapper(config, roof_lidar(), kMaxReturns);
  MapFuser fuser(config);
  oracle::Fusion expected(config.window, config.memory);
  BrickMapStorage storage[kSweeps];
  for (int i = 0; i < kSweeps; ++i) {
    CAPTURE(i);
    const Sweep sweep = read_sweep(*folder, kFirstFrame + i);
    REQUIRE(sweep.returns.size() > 100'000);
    const auto shape = mapper.count(sweep, odometry);
    const auto map = oracle::map_sweep(config, roof_lidar(), sweep, poses);
    REQUIRE((shape && map));
    REQUIRE(mapper.write(storage[i].resize(*shape)));
    const BrickMapView view = storage[i].view(mapper.grid(), sweep.stamp_ns, mapper.T_odom_base());
    REQUIRE(difference(view, *map) == "");
    REQUIRE(expected.add(*map));
    REQUIRE(fuser.add({view, 0, std::uint64_t(i)}) == AddResult::added);
    REQUIRE(difference(cpu_map(fuser)->view(), expected, config.layers.min_hits) == "");
    REQUIRE(export_difference(fuser, expected) == "");
    oracle::Layers layers(config.map.size_xy);
    REQUIRE(fuser.make_layers(layers.arrays()));
    REQUIRE(difference(layers, oracle::make_layers(config, expected)) == "");
  }
}

}  // namespace
}  // namespace gvom::test
