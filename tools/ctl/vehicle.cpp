#include "tools/ctl/vehicle.hpp"

#include <unistd.h>

#include "ipc/topic.hpp"
#include "services/common/bus/pool_spec.hpp"

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
  return expected;
}

tl::expected<Expected, services::ConfigError> expected_of(const std::string& path,
                                                          const std::vector<std::string>& sets) {
  if (path.empty() && ::access(kInstalledVehicle, F_OK) != 0)
    return Expected{"", {}, ipc::release(), {}, std::nullopt};
  return services::load_vehicle_config(path.empty() ? kInstalledVehicle : path, sets)
      .map([](const services::VehicleConfig& config) { return expected_of(config); });
}

Surroundings surroundings_of(Units& units) {
  return {tools::read_usage, [&units](const std::string& process) { return units.restarts(process); }};
}

}  // namespace gvom::ctl
