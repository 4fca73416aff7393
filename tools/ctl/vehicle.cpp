#include "tools/ctl/vehicle.hpp"

#include <unistd.h>

#include "ipc/topic.hpp"
#include "services/common/bus/pool_spec.hpp"
#include "services/common/config_concerns.hpp"

namespace gvom::ctl {

Expected expected_of(const services::VehicleConfig& config) {
  Expected expected;
  expected.vehicle = config.name;
  expected.version = ipc::release();
  expected.config_hash = services::config_hash(config);
  if (const auto plan = ipc::plan_pools(services::pool_spec(config))) expected.pools = plan->pools;
  if (!config.odometry.source.empty()) expected.processes.emplace_back("gvom-odometry");
  expected.processes.emplace_back("gvom-fusion");
  for (const services::LidarConfig& lidar : config.lidars)
    expected.processes.push_back(tools::kIngestPrefix + lidar.name);
  for (const std::string& process : expected.processes)
    expected.process_hashes[process] = services::config_hash(config, process);
  for (const char* process : {"gvom-odometry", "gvom-planner", "gvom-bridge"})  // where they run
    expected.process_hashes[process] = services::config_hash(config, process);
  return expected;
}

Expected expected_of(const std::string& path, const std::vector<std::string>& sets) {
  Expected nothing{"", {}, ipc::release()};
  if (path.empty() && ::access(kInstalledVehicle, F_OK) != 0) return nothing;
  const auto config = services::load_vehicle_config(path.empty() ? kInstalledVehicle : path, sets);
  if (config) return expected_of(*config);
  nothing.processes = {"gvom-fusion"};  // whatever the file says
  nothing.config_error = config.error().text();
  return nothing;
}

Surroundings surroundings_of(Units& units) {
  return {tools::read_usage, [&units](const std::string& process) { return units.restarts(process); },
          [&units](const std::string& process) {
            const auto state = units.state(process);
            return state ? why_not_running(*state) : "";
          },
          [&units](const std::string& process) {
            const auto state = units.state(process);
            return state && state->active == "failed";
          }};
}

}  // namespace gvom::ctl
