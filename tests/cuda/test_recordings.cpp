// What real lidars saw: the CUDA back end gives the bytes of the CPU, from the returns to the layers.
#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "services/common/config_file.hpp"
#include "tests/common/temporary_file.hpp"
#include "tests/cuda/gpu.hpp"
#include "tests/oracle/layers.hpp"
#include "tests/support/recordings.hpp"
#include "tools/compare/maps.hpp"
#include "tools/map/offline.hpp"

namespace gvom::test {
namespace {

struct Recording {
  std::string name;
  std::vector<std::string> sources;  // of each lidar; FOLDER is that of all recordings
  std::string odometry;              // tum:FILE or static
};

const std::vector<Recording> kRecordings = {
    {"KITTI", {"scans:FOLDER/kitti_drive0005"}, "tum:FOLDER/kitti_drive0005/odometry.tum"},
    {"OS1-128",
     {"ouster:FOLDER/ouster_os1_128_moving/os1_128.pcap?meta=FOLDER/ouster_os1_128_moving/os1_128.json"},
     "tum:FOLDER/ouster_os1_128_moving/odometry.tum"},
    {"OS1-64, legacy",
     {"ouster:FOLDER/ouster_os1_64_legacy/os1_64.pcap?meta=FOLDER/ouster_os1_64_legacy/os1_64.json"},
     "static"},
    {"OS2-128",
     {"ouster:FOLDER/ouster_variants/os2_128_rng19.pcap?meta=FOLDER/ouster_variants/os2_128_rng19.json"},
     "static"},
    {"OS1-32, legacy",
     {"ouster:FOLDER/ouster_variants/os1_32_legacy.pcap?meta=FOLDER/ouster_variants/os1_32_legacy.json"},
     "static"},
    {"HDL-32", {"velodyne:FOLDER/velodyne/hdl32.pcap?model=HDL-32"}, "static"},
    {"VLP-16 indoors", {"velodyne:FOLDER/velodyne/vlp16_gps.pcap?model=VLP-16"}, "static"},
    {"VLP-16 outdoors",
     {"velodyne:FOLDER/velodyne/vlp16_outdoor.pcap?model=VLP-16&model_byte=0x21"},
     "static"},
    {"RELLIS, two lidars",
     {"scans:FOLDER/rellis_offroad/os1_64.bin", "scans:FOLDER/rellis_offroad/vlp32.bin"},
     "static"},
    {"forest", {"scans:FOLDER/forest/marv_ouster.pcd"}, "static"},
};

std::string in_folder(std::string text, const std::string& folder) {
  for (std::size_t at = text.find("FOLDER"); at != std::string::npos; at = text.find("FOLDER"))
    text.replace(at, 6, folder);
  return text;
}

services::VehicleConfig vehicle(const Recording& recording, const std::string& folder, Backend backend) {
  std::string text = "name: recorded\nlidars:\n";
  for (std::size_t i = 0; i < recording.sources.size(); ++i)
    text += "  lidar_" + std::to_string(i) +
            ":\n    T_base_sensor: {x: 0.1, y: 0, z: 1.7, roll: 0, pitch: 0.02, yaw: 0}\n    source: '" +
            in_folder(recording.sources[i], folder) + "'\n";
  const TemporaryFile file(text);
  auto config = services::load_vehicle_config(file.path(), {});
  REQUIRE(config);
  config->fusion.backend = backend;
  for (services::LidarConfig& lidar : config->lidars) lidar.backend = backend;
  return *config;
}

// Sweeps that both mapped to the same bytes.
int compare(const Recording& recording, const std::string& folder) {
  const std::string odometry = in_folder(recording.odometry, folder);
  auto cpu = tools::OfflineMapper::open(vehicle(recording, folder, Backend::cpu), odometry);
  auto cuda = tools::OfflineMapper::open(vehicle(recording, folder, Backend::cuda), odometry);
  REQUIRE(cpu);
  REQUIRE(cuda);
  REQUIRE(cuda->fusion_backend().name == "cuda");
  tools::MappedSweep expected, found;
  int sweeps = 0;
  while (cpu->next(expected).value()) {
    CAPTURE(sweeps);
    REQUIRE(cuda->next(found).value());
    REQUIRE(found.stamp_ns == expected.stamp_ns);
    REQUIRE(found.filter.used == expected.filter.used);
    const int n = cpu->fuser().moment().grid.size[0];
    oracle::Layers expected_layers(n), found_layers(n);
    REQUIRE(cpu->make_layers(expected_layers.arrays()));
    REQUIRE(cuda->make_layers(found_layers.arrays()));
    REQUIRE(compare::layers_difference(expected_layers.arrays(), found_layers.arrays(), n) == "");
    ++sweeps;
  }
  REQUIRE_FALSE(cuda->next(found).value());
  return sweeps;
}

TEST_CASE("CPU and CUDA give the same bytes on every recording") {
  const auto folder = recordings();
  if (!folder || !has_gpu()) return;
  for (const Recording& recording : kRecordings) {
    CAPTURE(recording.name);
    CHECK(compare(recording, *folder) > 0);
  }
}

}  // namespace
}  // namespace gvom::test
