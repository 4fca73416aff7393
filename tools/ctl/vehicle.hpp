// What gvomctl looks for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/config_file.hpp"
#include "tools/ctl/snapshot.hpp"
#include "tools/ctl/units.hpp"

namespace gvom::ctl {

/// Where the units have the vehicle's file.
inline constexpr char kInstalledVehicle[] = "/etc/gvom/vehicle.yaml";

/// The processes that the vehicle's file asks for: fusion, each lidar's, and gvom-odometry if there is an
/// odometry.source (a vehicle's own odometry comes from some process of its own).
Expected expected_of(const services::VehicleConfig& config);

/// Of the file at `path`; where that is empty, of kInstalledVehicle if it is there, else nothing. Of one that
/// does not load it has the reason, and fusion.
Expected expected_of(const std::string& path, const std::vector<std::string>& sets);

/// From /proc and `units`, which must outlive it.
Surroundings surroundings_of(Units& units);

}  // namespace gvom::ctl
