// Does a vehicle's file work on this machine, for the user who asks?
#pragma once

#include <string>
#include <vector>

#include "services/common/vehicle_config.hpp"

namespace gvom::ctl {

enum class Level { ok, warning, error };

/// One line: what was looked at, what was found, and if it is not ok what to do.
struct Finding {
  Level level;
  std::string what;  ///< "pools", "lidar front", ...
  std::string message;
};

using Findings = std::vector<Finding>;

/// The pools by their plan, room in /dev/shm, and whose files are in the way there and in /tmp.
Findings check_memory(const services::VehicleConfig& config);

/// Each lidar's source, as gvom-ingest --check: sweeps of a recording are decoded, a port is bound for a
/// moment. A port that the lidar's own gvom-ingest holds is well.
Findings check_lidars(const services::VehicleConfig& config);

/// Odometry, the back ends that are asked for, and limits of this shell (units have their own).
Findings check_machine(const services::VehicleConfig& config);

Findings check_vehicle(const services::VehicleConfig& config);

/// "ok", "warning", "error".
const char* to_string(Level level);
bool has_error(const Findings& findings);
std::string to_table(const Findings& findings);
std::string to_json(const services::VehicleConfig& config, const Findings& findings);

}  // namespace gvom::ctl
