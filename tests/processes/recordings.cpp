#include "tests/processes/recordings.hpp"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "services/ingest/source.hpp"

namespace gvom::test {

namespace fs = std::filesystem;

Vehicle two_lidars(const std::string& folder) {
  Vehicle vehicle{GVOM_SOURCE_DIR "/config/vehicles/two_lidars.yaml", {"front", "rear"}, folder, small_map()};
  vehicle.sets.insert(vehicle.sets.end(),
                      {"lidars.front.max_returns=65536", "lidars.rear.max_returns=65536"});
  return vehicle;
}

Vehicle simulated(const std::string& folder, double seconds, double speed_mps) {
  Vehicle vehicle = two_lidars(folder);
  const Ended made = run("gvom-sim",
                         {"--config", vehicle.file, "--seconds", std::to_string(seconds), "--speed",
                          std::to_string(speed_mps), "--out", folder},
                         folder);
  INFO(made.output);
  REQUIRE(made.code == 0);
  return vehicle;
}

Vehicle front_only(const std::string& folder) {
  const std::string file = folder + "/front_only.yaml";
  std::ofstream(file) << "name: front_only\n"
                         "odometry: {source: tum:odometry.tum, timeout_s: 10, max_clock_offset_s: 60}\n"
                         "lidars:\n"
                         "  front:\n"
                         "    source: ouster:front.pcap?meta=front.json\n"
                         "    max_returns: 65536\n"
                         "    T_base_sensor: {x: 0.45, y: 0.0, z: 0.95, roll: 0, pitch: 0.10, yaw: 0}\n";
  return {file, {"front"}, folder, small_map()};
}

std::optional<std::string> kitti_recording() {
  const char* set = std::getenv("GVOM_SHARED");
  const std::string shared = set != nullptr ? set : GVOM_SOURCE_DIR "/../shared";
  const std::string folder = shared + "/data/kitti_drive0005";
  if (fs::is_directory(folder)) return folder;
  WARN("SKIPPED: no recording at " + folder + " (set GVOM_SHARED)");
  return std::nullopt;
}

Vehicle kitti(const std::string& folder, const std::string& recording) {
  Vehicle vehicle{GVOM_SOURCE_DIR "/config/vehicles/kitti.yaml", {"top"}, folder, small_map()};
  vehicle.sets.insert(vehicle.sets.end(),
                      {"lidars.top.max_returns=131072", "lidars.top.source=scans:" + recording,
                       "odometry.source=tum:" + recording + "/odometry.tum"});
  return vehicle;
}

Vehicle roof_lidars(const std::string& folder, const std::string& odometry,
                    const std::vector<std::pair<std::string, std::string>>& sources) {
  Vehicle vehicle{folder + "/roof.yaml", {}, folder, small_map()};
  std::ofstream file(vehicle.file);
  file << "name: roof\nodometry: {source: 'tum:" << odometry << "'}\nmemory: {max_age_s: 0}\nlidars:\n";
  for (const auto& [name, uri] : sources) {
    file << "  " << name << ":\n    source: '" << uri << "'\n    max_returns: 131072\n"
         << "    T_base_sensor: {x: 0, y: 0, z: 1.73, roll: 0, pitch: 0, yaw: 0}\n";
    vehicle.lidars.push_back(name);
  }
  return vehicle;
}

std::string scans_of_simulated(const std::string& folder) {
  const std::string scans = folder + "/scans";
  fs::create_directories(scans);
  auto source = ingest::open_source("ouster:" + folder + "/front.pcap?meta=" + folder + "/front.json", {});
  REQUIRE(source);
  std::ofstream times(scans + "/times.txt");
  Sweep sweep;
  for (int i = 0;; ++i) {
    const auto event = (*source)->next(sweep, std::chrono::milliseconds(0));
    REQUIRE(event);
    if (*event == ingest::SourceEvent::kEnd) return scans;
    times << sweep.stamp_ns / 1'000'000'000 << "."
          << std::to_string(1'000'000'000 + sweep.stamp_ns % 1'000'000'000).substr(1) << "\n";
    std::ofstream bin(scans + "/" + std::to_string(100000 + i) + ".bin", std::ios::binary);
    for (const Return& r : sweep.returns) {
      const float point[4] = {static_cast<float>(r.x_m), static_cast<float>(r.y_m), static_cast<float>(r.z_m),
                              0.0F};
      bin.write(reinterpret_cast<const char*>(point), sizeof point);
    }
  }
}

}  // namespace gvom::test
