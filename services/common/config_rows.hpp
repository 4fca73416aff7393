// The one table of configuration keys. Parsing, --set, --print-config and the reference all go by it;
// the default of a key is what its field holds in a default-constructed struct.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "services/common/vehicle_config.hpp"

namespace gvom::services {

/// One corner of a box that may be absent. Setting one corner makes the box, with the other corner NaN.
struct BoxCorner {
  std::optional<Box>* box;
  Eigen::Vector3d Box::*corner;
};

using Field = std::variant<double*, int*, std::string*, Backend*, LidarClock*, BoxCorner>;

enum class Rule {
  range,          ///< min .. max
  above_min,      ///< The same without min itself.
  multiple_of_8,  ///< min .. max
  odd,            ///< min .. max
  identifier,     ///< [a-z0-9_], 1 to 31 characters.
  text,           ///< One line of any text.
  choice,         ///< One of a back end's words.
  clock,          ///< One of a clock's words.
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

bool is_identifier(const std::string& text);

}  // namespace gvom::services
