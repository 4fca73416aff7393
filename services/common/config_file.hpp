// A vehicle's YAML file to config structs, strictly: an unknown, repeated, missing, mistyped or
// out-of-range key is an error that names the place, the key and what was expected.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/vehicle_config.hpp"

namespace gvom::services {

struct ConfigError {
  std::string where;    ///< `FILE:LINE`, `FILE`, or `--set KEY=VALUE` as it was given.
  std::string key;      ///< The whole key, `lidars.top.max_range_m`; empty if it is not about one.
  std::string message;  ///< What was found and what was expected.

  /// `where: key: message`, one line.
  [[nodiscard]] std::string text() const;
};

/// Reads `path`, then applies `sets` in order: each `KEY=VALUE`, VALUE being YAML (a number, a list, a
/// string). A set overrides the file and earlier sets; it cannot add a lidar. Ranges and cross checks
/// hold for the result. Relative paths in `source` keys stay as they are: relative to the working directory.
tl::expected<VehicleConfig, ConfigError> load_vehicle_config(const std::string& path,
                                                             const std::vector<std::string>& sets = {});

/// Complete YAML, each key with range, unit and meaning as a comment; it loads again to the same config.
void print_config(const VehicleConfig& config, std::ostream& out);

/// What the configuration resolves to, in a number: FNV-1a, 64 bits, over what print_config prints.
std::uint64_t config_hash(const VehicleConfig& config);

/// The table of all keys (key, default, unit, range, meaning) in Markdown.
void print_config_reference(std::ostream& out);

/// The lidar of that name, or an error that lists the names there are. The pointer is into `config`.
tl::expected<const LidarConfig*, ConfigError> find_lidar(const VehicleConfig& config, std::string_view name);

/// `T_base_sensor` from its six numbers.
Eigen::Isometry3d to_isometry(const Extrinsic& extrinsic);

}  // namespace gvom::services
