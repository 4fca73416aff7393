// From a vehicle's configuration to a recording with its truth.
#pragma once

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/vehicle_config.hpp"
#include "tools/sim/recording.hpp"

namespace gvom::sim {

/// The simulated lidars of the vehicle, in order of their names: their UDP ports as in `ouster-udp:PORT` or
/// `velodyne-udp:PORT`, else 7502 and up; they turn out of step with each other.
std::vector<LidarModel> make_lidars(const services::VehicleConfig& vehicle, const RecordingOptions& options);

/// The path's length that the whole drive needs, the last lidar's last sweep too.
double path_length_m(const services::VehicleConfig& vehicle, const RecordingOptions& options);

struct Simulated {
  int sweeps;  ///< Of each lidar; fewer than asked for where the path ends sooner.
  double driven_m;
};

/// Writes the recording and its truth into `directory`, which is made if it is not there.
tl::expected<Simulated, std::string> simulate(const services::VehicleConfig& vehicle, const World& world,
                                              const RecordingOptions& options, const std::string& directory);

}  // namespace gvom::sim
