// What a whole key, such as `lidars.top.T_base_sensor.x`, stands for.
#pragma once

#include <optional>
#include <string>

#include "services/common/config_rows.hpp"

namespace gvom::services {

/// `lidars.NAME[.REST]` in its parts.
struct LidarKey {
  std::string name;
  std::string rest;  ///< Empty for `lidars.NAME` itself.
};
std::optional<LidarKey> split_lidar_key(const std::string& key);

struct Target {
  const RowInfo* row;
  Field field;
};
/// The row and the field of a key that holds a value. Nothing if there is no such key, or no such lidar.
std::optional<Target> find_target(VehicleConfig& config, const std::string& key);

/// Whether keys begin with `key` and a dot, so that it is a mapping of keys; the empty key is the root.
bool is_section(const std::string& key);

/// The key that `key` is probably a misspelling of; empty if none is near.
std::string nearest_key(const std::string& key);

LidarConfig* lidar_named(VehicleConfig& config, const std::string& name);

}  // namespace gvom::services
