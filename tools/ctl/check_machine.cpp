#include <fmt/format.h>
#include <sys/resource.h>

#include "core/open_backend.hpp"
#include "ipc/broker.hpp"
#include "services/common/bus/pool_spec.hpp"
#include "services/common/odometry_file.hpp"
#include "services/common/vehicle_config.hpp"
#include "tools/ctl/check.hpp"

namespace gvom::ctl {

namespace {

Finding check_odometry(const services::VehicleConfig& config) {
  const std::string& source = config.odometry.source;
  if (source.empty())
    return {Level::ok, "odometry", "no odometry.source: some process of the vehicle must publish it"};
  if (source.rfind("ros2:", 0) == 0)
    return {Level::ok, "odometry", source + ": live; Health of gvom-odometry says whether it comes"};
  std::vector<std::string> warnings;
  const auto poses = services::read_odometry_source(source, warnings);
  if (!poses) return {Level::error, "odometry", poses.error()};
  return {warnings.empty() ? Level::ok : Level::warning, "odometry",
          fmt::format("{}: {} poses{}{}", source, poses->size(), warnings.empty() ? "" : "; ",
                      fmt::join(warnings, "; "))};
}

template <typename Opened>
Finding judge_backend(const std::string& what, Backend asked, const Opened& opened) {
  if (!opened)
    return {Level::error, what,
            fmt::format("{} cannot start: {}", services::word_of(asked), opened.error().what)};
  return {Level::ok, what,
          fmt::format("{} gives {}: {}", services::word_of(asked), opened->name, opened->details)};
}

Finding check_fusion(const services::VehicleConfig& config) {
  FusionSetup setup;
  setup.config = config.mapper;
  setup.lidars = static_cast<int>(config.lidars.size());
  setup.max_returns = static_cast<std::size_t>(services::pool_spec(config).max_returns);
  return judge_backend("fusion.backend", config.fusion.backend, open_fusion(config.fusion.backend, setup));
}

Finding check_voxelizer(const services::VehicleConfig& config, const services::LidarConfig& lidar) {
  VoxelizerSetup setup;
  setup.map = config.mapper.map;
  setup.lidar = lidar.geometry;
  setup.vehicle = config.mapper.vehicle;
  setup.max_returns = static_cast<std::size_t>(lidar.max_returns);
  return judge_backend(lidar.name + ".backend", lidar.backend, open_voxelizer(lidar.backend, setup));
}

std::uint64_t limit_of(__rlimit_resource resource) {
  rlimit limit{};
  ::getrlimit(resource, &limit);
  return limit.rlim_cur;
}

Finding check_locked_memory(const ipc::PoolPlan& plan) {
  const std::uint64_t limit = limit_of(RLIMIT_MEMLOCK);
  const std::uint64_t needed = ipc::shared_memory_bytes(plan);
  if (limit >= needed) return {Level::ok, "locked memory", "the limit leaves room for all shared memory"};
  return {Level::warning, "locked memory",
          fmt::format("{:.1f} MB may be locked here, {:.0f} MB are shared: pages can be swapped out. "
                      "LimitMEMLOCK=infinity in a unit, ulimit -l unlimited in a shell",
                      static_cast<double>(limit) * 1e-6, static_cast<double>(needed) * 1e-6)};
}

Finding check_priority() {
  const std::uint64_t limit = limit_of(RLIMIT_RTPRIO);
  return {Level::ok, "priority",
          limit == 0 ? "no real-time priority here; only units that ask for fifo scheduling need one"
                     : fmt::format("real-time priorities up to {}", limit)};
}

}  // namespace

Findings check_machine(const services::VehicleConfig& config) {
  Findings findings = {check_odometry(config)};
  if (const auto plan = ipc::plan_pools(services::pool_spec(config))) {
    findings.push_back(check_fusion(config));
    for (const services::LidarConfig& lidar : config.lidars)
      findings.push_back(check_voxelizer(config, lidar));
    findings.push_back(check_locked_memory(*plan));
  } else {
    findings.push_back({Level::warning, "back ends", "not opened: first make the pools fit"});
  }
  findings.push_back(check_priority());
  return findings;
}

}  // namespace gvom::ctl
