// The one table of configuration keys, and what is done with a key and its value. Parsing, --set,
// --print-config and the reference all go by it; the default of a key is what its field holds in a
// default-constructed struct.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <tl/expected.hpp>

#include "services/common/vehicle_config.hpp"

namespace gvom::services {

/// One corner of a box that may be absent. Setting one corner makes the box, with the other corner NaN.
struct BoxCorner {
  std::optional<Box>* box;
  Eigen::Vector3d Box::*corner;
};

using Field = std::variant<double*, int*, std::string*, Backend*, LidarClock*, planner::Steering*, BoxCorner>;

enum class Rule {
  range,          ///< min .. max
  above_min,      ///< The same without min itself.
  multiple_of_8,  ///< min .. max
  odd,            ///< min .. max
  identifier,     ///< [a-z0-9_], 1 to 31 characters.
  text,           ///< One line of any text.
  choice,         ///< One of a back end's words.
  clock,          ///< One of a clock's words.
  steering,       ///< One of a steering's words.
  corner,         ///< A list [x, y, z], each in min .. max.
};

struct RowInfo {
  const char* key;  ///< From the root (VehicleRow), or from `lidars.NAME` (LidarRow).
  const char* unit;
  Rule rule;
  double min;
  double max;
  bool required;
  const char* meaning;
};

template <typename Config>
struct Row {
  RowInfo info;
  Field (*field)(Config&);
};

using VehicleRow = Row<VehicleConfig>;
using LidarRow = Row<LidarConfig>;

/// Rows of one section stand together, in the order in which they are printed.
const std::vector<VehicleRow>& vehicle_rows();
const std::vector<LidarRow>& lidar_rows();
/// Those of vehicle_rows() that a planner reads: `vehicle.*` and `planner.*`.
std::vector<VehicleRow> limit_rows();
std::vector<VehicleRow> planner_rows();
/// Those that the bridge reads: `bridge.*`.
std::vector<VehicleRow> bridge_rows();

bool is_identifier(const std::string& text);

// A whole key, such as `lidars.top.T_base_sensor.x`.

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

// One value: from YAML into its field, and back to text.

/// Sets the field, or says what was expected and what was found.
tl::expected<void, std::string> assign(const RowInfo& row, const YAML::Node& node, const Field& field);

/// What a row takes: "a whole number in 8 .. 1024, a multiple of 8".
std::string expected_text(const RowInfo& row, const Field& field);

/// The bounds alone, "8 .. 1024, a multiple of 8", or the words to choose from; empty where there are none.
std::string range_text(const RowInfo& row);

/// YAML that `assign` reads back as the same value; empty for a corner of an absent box.
std::string value_text(const Field& field);

// What no single key can tell: keys that contradict each other.

struct Conflict {
  std::string key;
  std::string other_key;
  std::string message;
};

std::optional<Conflict> find_conflict(const VehicleConfig& config);

}  // namespace gvom::services
