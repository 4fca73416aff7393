#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <memory>

#include "services/ingest/source_options.hpp"
#include "services/ingest/udp_socket.hpp"
#include "services/ingest/uri.hpp"
#include "tools/ctl/check.hpp"
#include "tools/ctl/udp_ports.hpp"

namespace gvom::ctl {

namespace {

using services::LidarConfig;

std::optional<std::uint16_t> live_port(const LidarConfig& lidar) {
  const auto uri = ingest::parse_source_uri(lidar.source);
  if (!uri || (uri->scheme != "ouster-udp" && uri->scheme != "velodyne-udp")) return std::nullopt;
  const auto port = ingest::parse_port(uri->path);
  return port ? std::optional<std::uint16_t>(*port) : std::nullopt;
}

/// "gvom-ingest ... --lidar NAME ...", by whatever path.
bool is_ingest_of(const PortOwner& owner, const std::string& lidar) {
  const std::string words = owner.command + " ";
  return words.find("gvom-ingest") != std::string::npos &&
         (words.find("--lidar " + lidar + " ") != std::string::npos ||
          words.find("--lidar=" + lidar + " ") != std::string::npos);
}

/// Why a port that cannot be bound is taken; nothing if the owner is not known.
std::optional<Finding> judge_owner(const LidarConfig& lidar, const std::string& what) {
  const auto port = live_port(lidar);
  const auto owner = port ? owner_of_port(*port) : std::nullopt;
  if (!owner) return std::nullopt;
  if (owner->pid == ::getpid())
    return Finding{Level::error, what,
                   fmt::format("UDP port {}: another lidar of this vehicle has the same", *port)};
  if (is_ingest_of(*owner, lidar.name))
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
  auto source = ingest::open_source(lidar.source, ingest::source_options(lidar));
  if (!source) {
    const bool port = source.error().kind == ingest::SourceError::Kind::unavailable;
    if (auto taken = port ? judge_owner(lidar, what) : std::nullopt) return *taken;
    return {Level::error, what, source.error().what};
  }
  if (auto lack = ingest::lack_of_room(lidar.name, static_cast<std::size_t>(lidar.max_returns), **source);
      !lack.empty())
    return {Level::error, what, std::move(lack)};
  std::string warnings;
  for (const std::string& warning : (*source)->warnings()) warnings += "; " + warning;
  opened.push_back(std::move(*source));
  return {warnings.empty() ? Level::ok : Level::warning, what, lidar.source + " opens" + warnings};
}

/// Root may go beyond the limit, the services' user may not.
Finding check_receive_buffers() {
  long long limit_bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> limit_bytes;
  const std::string limit = fmt::format("net.core.rmem_max is {} bytes", limit_bytes);
  if (limit_bytes >= ingest::kSufficientBuffer) return {Level::ok, "receive buffers", limit};
  return {Level::warning, "receive buffers",
          fmt::format("{}, too few for a burst of packets: sysctl net.core.rmem_max={}", limit,
                      ingest::kWantedBuffer)};
}

}  // namespace

Findings check_lidars(const services::VehicleConfig& config) {
  Findings findings;
  Opened opened;
  bool any_live = false;
  for (const LidarConfig& lidar : config.lidars) {
    findings.push_back(check_source(lidar, opened));
    any_live = any_live || live_port(lidar);
  }
  if (any_live) findings.push_back(check_receive_buffers());
  return findings;
}

}  // namespace gvom::ctl
