#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <memory>

#include "services/ingest/source_check.hpp"
#include "services/ingest/udp_ports.hpp"
#include "services/ingest/udp_socket.hpp"
#include "tools/ctl/check.hpp"

namespace gvom::ctl {

namespace {

using services::LidarConfig;

/// Why a port that cannot be bound is taken; nothing if the owner is not known.
std::optional<Finding> judge_owner(const LidarConfig& lidar, const std::string& what) {
  const auto port = ingest::live_port(lidar.source);
  const auto owner = port ? ingest::owner_of_port(*port) : std::nullopt;
  if (!owner) return std::nullopt;
  if (owner->pid == ::getpid())
    return Finding{Level::error, what,
                   fmt::format("UDP port {}: another lidar of this vehicle has the same", *port)};
  if (ingest::is_ingest_of(*owner, lidar.name))
    return Finding{Level::ok, what,
                   fmt::format("its process runs (pid {}) and has port {}", owner->pid, *port)};
  return Finding{Level::error, what,
                 fmt::format("UDP port {} is taken by process {} ({}): end that, or give "
                             "the lidar another port",
                             *port, owner->pid, owner->command)};
}

using Opened = std::vector<std::unique_ptr<ingest::Source>>;  // kept: ports of one vehicle must differ

Finding check_source(const LidarConfig& lidar, Opened& opened) {
  const std::string what = "lidar " + lidar.name;
  if (lidar.source.empty())
    return {Level::error, what, fmt::format("lidars.{}.source is empty: give one", lidar.name)};
  auto checked = ingest::check_source(lidar);
  if (!checked) {
    const bool port = checked.error().kind == ingest::SourceError::Kind::unavailable;
    if (auto taken = port ? judge_owner(lidar, what) : std::nullopt) return *taken;
    return {Level::error, what, checked.error().what};
  }
  std::string found = lidar.source + ": " + checked->found;
  for (const std::string& warning : checked->warnings) found += "; " + warning;
  opened.push_back(std::move(checked->source));
  return {checked->warnings.empty() ? Level::ok : Level::warning, what, std::move(found)};
}

/// Root may go beyond the limit, the services' user may not.
Finding check_receive_buffers() {
  long long limit_bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> limit_bytes;
  const std::string limit = fmt::format("net.core.rmem_max is {} bytes", limit_bytes);
  if (limit_bytes >= ingest::kSufficientBuffer) return {Level::ok, "receive buffers", limit};
  return {Level::warning, "receive buffers",
          fmt::format("{}, too few for a burst of packets, or a cloud of ROS 2: sysctl net.core.rmem_max={}",
                      limit, ingest::kWantedBuffer)};
}

}  // namespace

Findings check_lidars(const services::VehicleConfig& config) {
  Findings findings;
  Opened opened;
  bool any_live = false;
  for (const LidarConfig& lidar : config.lidars) {
    findings.push_back(check_source(lidar, opened));
    any_live = any_live || ingest::live_port(lidar.source) || lidar.source.rfind("ros2:", 0) == 0;
  }
  if (any_live) findings.push_back(check_receive_buffers());
  return findings;
}

}  // namespace gvom::ctl
