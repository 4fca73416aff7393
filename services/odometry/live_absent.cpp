#include "services/odometry/live.hpp"

namespace gvom::odometry {

std::string fault_of(const std::string& source) {
  return "odometry source '" + source + "': this gvom was built without Cyclone DDS (cyclonedds-dev)";
}

services::ExitCode run_live(const std::string&, std::uint64_t, ipc::Runtime&, services::Lifecycle&) {
  return services::ExitCode::configuration;
}

}  // namespace gvom::odometry
