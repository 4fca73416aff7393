// `--bag PATH`: the sources of a vehicle's file that leave the bag open.
#pragma once

#include <string>

#include "services/common/vehicle_config.hpp"

namespace gvom::tools {

/// `bag:?topic=T` and `bag:?tf=P/C` get `path`; nothing else changes. True if `source` was one of these.
bool fill_bag(std::string& source, const std::string& path);

/// Of all lidars and the odometry; how many there were.
int fill_bag(services::VehicleConfig& config, const std::string& path);

}  // namespace gvom::tools
