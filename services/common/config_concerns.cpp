#include "services/common/config_concerns.hpp"

#include <algorithm>
#include <cstring>

#include "services/common/config_table.hpp"
#include "services/common/text_hash.hpp"

namespace gvom::services {

namespace {

constexpr char kIngestPrefix[] = "gvom-ingest-";

std::string lidar_of(const std::string& process) {
  const std::size_t length = std::strlen(kIngestPrefix);
  return process.compare(0, length, kIngestPrefix) == 0 ? process.substr(length) : "";
}

/// The key as the table has it: lidars.top.source -> lidars.NAME.source.
std::string general(const std::string& key) {
  const auto lidar = split_lidar_key(key);
  if (!lidar) return key;
  return lidar->rest.empty() ? "lidars.NAME" : "lidars.NAME." + lidar->rest;
}

unsigned concern_of(const std::string& key) {
  const std::string name = general(key);
  std::size_t longest = 0;
  unsigned concern = kNobody;
  for (const KeyConcern& row : key_concerns()) {
    const std::size_t length = std::strlen(row.key);
    const bool fits = name.compare(0, length, row.key) == 0 && (name.size() == length || name[length] == '.');
    if (!fits || length < longest) continue;
    longest = length;
    concern = row.concern;
  }
  return concern;
}

}  // namespace

const std::vector<KeyConcern>& key_concerns() {
  static const std::vector<KeyConcern> rows = {
      {"name", kNobody},
      {"map", kFusion | kIngests},
      {"map.size_xy", kFusion | kIngests | kBroker | kPlanner},
      {"map.size_z", kFusion | kIngests | kBroker},
      {"window", kFusion},
      {"window.buffer_size", kFusion | kBroker},
      {"memory", kFusion},
      {"vehicle", kPlanner},
      {"vehicle.body_min_m", kIngests},
      {"vehicle.body_max_m", kIngests},
      {"vehicle.radius_m", kFusion | kIngests},
      {"vehicle.base_height_m", kFusion | kIngests},
      {"layers", kFusion},
      {"cost", kFusion},
      {"fusion", kFusion},
      {"fusion.voxel_rate_hz", kFusion | kBroker},
      {"ipc", kBroker},
      {"planner", kPlanner},
      {"bridge", kBridge},
      {"odometry", kIngests},
      {"odometry.max_speed_mps", kIngests | kPlanner},
      {"odometry.source", kOdometry},
      {"lidars", kFusion | kOdometry | kBroker | kPlanner},  // which lidars there are
      {"lidars.NAME", kIngest},
      {"lidars.NAME.T_base_sensor.yaw", kIngest | kPlanner},
      {"lidars.NAME.max_returns", kIngest | kFusion | kBroker},
  };
  return rows;
}

bool concerns(const std::string& key, const std::string& process) {
  const unsigned concern = concern_of(key);
  if (process == "gvom-roudi") return (concern & kBroker) != 0;
  if (process == "gvom-fusion") return (concern & kFusion) != 0;
  if (process == "gvom-odometry") return (concern & kOdometry) != 0;
  if (process == "gvom-planner") return (concern & kPlanner) != 0;
  if (process == "gvom-bridge") return (concern & kBridge) != 0;
  const std::string lidar = lidar_of(process);
  if (lidar.empty()) return false;
  const auto of_lidar = split_lidar_key(key);
  return (concern & kIngests) != 0 || ((concern & kIngest) != 0 && of_lidar && of_lidar->name == lidar);
}

std::string who_is_concerned(const std::string& key) {
  const unsigned concern = concern_of(key);
  std::string who;
  const auto add = [&](unsigned one, const char* name) {
    if ((concern & one) != 0) who += (who.empty() ? "" : ", ") + std::string(name);
  };
  add(kFusion, "gvom-fusion");
  add(kIngests, "every gvom-ingest");
  add(kIngest, "gvom-ingest@NAME");
  add(kOdometry, "gvom-odometry");
  add(kPlanner, "gvom-planner");
  add(kBridge, "gvom-bridge");
  add(kBroker, "everything if the pools of shared memory change");
  return who.empty() ? "nobody" : who;
}

std::string concerns_table() {
  std::string table;
  for (const KeyConcern& row : key_concerns()) {
    std::string key = row.key;
    key.resize(std::max<std::size_t>(key.size(), 26), ' ');
    table += key + who_is_concerned(row.key) + "\n";
  }
  return table;
}

std::uint64_t config_hash(const VehicleConfig& config, const std::string& process) {
  VehicleConfig copy = config;  // accessors hand out writable fields
  TextHash hash;
  for (const VehicleRow& row : vehicle_rows())
    if (concerns(row.info.key, process))
      hash.add(std::string(row.info.key) + ": " + value_text(row.field(copy)) + "\n");
  for (LidarConfig& lidar : copy.lidars) {
    const std::string prefix = "lidars." + lidar.name;
    if (concerns("lidars", process)) hash.add(prefix + "\n");
    for (const LidarRow& row : lidar_rows()) {
      const std::string key = prefix + "." + row.info.key;
      if (concerns(key, process)) hash.add(key + ": " + value_text(row.field(lidar)) + "\n");
    }
  }
  return hash.value();
}

}  // namespace gvom::services
