// Which key of the vehicle's file concerns which process: who runs with another configuration than the
// file's, and whom `gvomctl reload` restarts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/common/vehicle_config.hpp"

namespace gvom::services {

/// Sets of processes.
enum Concern : unsigned {
  kNobody = 0,
  kFusion = 1,
  kIngests = 2,   ///< All of them.
  kIngest = 4,    ///< That of the key's own lidar.
  kOdometry = 8,  ///< gvom-odometry, which replays.
  kPlanner = 32,  ///< gvom-planner.
  kBridge = 64,   ///< gvom-bridge.
  kBroker = 16,   ///< It decides the pools of shared memory: if they change, everything starts again.
};

/// The keys that are `key` or begin with it and a dot; the longest that fits a key holds. `lidars.NAME`
/// stands for that of any lidar.
struct KeyConcern {
  const char* key;
  unsigned concern;
};
const std::vector<KeyConcern>& key_concerns();

/// Whether `key`, such as lidars.top.source, concerns the process of that runtime name.
bool concerns(const std::string& key, const std::string& process);

/// In words: "gvom-fusion, everything if the pools of shared memory change". The key may be one of the
/// table's.
std::string who_is_concerned(const std::string& key);

/// The table as it is printed: "layers.*   gvom-fusion".
std::string concerns_table();

/// A number for what in the configuration concerns one process: the values of its keys, and which lidars
/// there are if it serves all of them. ipc::Health has it.
std::uint64_t config_hash(const VehicleConfig& config, const std::string& process);

}  // namespace gvom::services
