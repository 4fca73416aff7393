#include "tools/ctl/vehicle.hpp"

#include <grp.h>
#include <pwd.h>
#include <unistd.h>

#include "ipc/broker_probe.hpp"

namespace gvom::ctl {

Expected expected_of(const services::VehicleConfig& config) {
  Expected expected{config.name, {}};
  if (!config.odometry.source.empty()) expected.processes.emplace_back("gvom-odometry");
  expected.processes.emplace_back("gvom-fusion");
  for (const services::LidarConfig& lidar : config.lidars)
    expected.processes.push_back(tools::kIngestPrefix + lidar.name);
  return expected;
}

tl::expected<Expected, services::ConfigError> expected_of(const std::string& path,
                                                          const std::vector<std::string>& sets) {
  if (path.empty() && ::access(kInstalledVehicle, F_OK) != 0) return Expected{};
  return services::load_vehicle_config(path.empty() ? kInstalledVehicle : path, sets)
      .map([](const services::VehicleConfig& config) { return expected_of(config); });
}

bool become_broker_user() {
  const auto owner = ipc::broker_owner();
  if (::geteuid() != 0 || !owner || owner->user == 0) return true;
  const passwd* const user = ::getpwuid(owner->user);
  const bool groups_set =
      user != nullptr ? ::initgroups(user->pw_name, owner->group) == 0 : ::setgroups(0, nullptr) == 0;
  return groups_set && ::setresgid(owner->group, owner->group, owner->group) == 0 &&
         ::setresuid(owner->user, owner->user, owner->user) == 0;
}

Surroundings surroundings_of(Units& units) {
  return {tools::read_usage, [&units](const std::string& process) { return units.restarts(process); }};
}

}  // namespace gvom::ctl
