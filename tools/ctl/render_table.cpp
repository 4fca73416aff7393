#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/ctl/render.hpp"

namespace gvom::ctl {

namespace {

template <typename T>
std::string cell(const char* format, const std::optional<T>& value) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

std::string headline(const Snapshot& snapshot) {
  const std::string vehicle = !snapshot.vehicle.empty() ? snapshot.vehicle
                              : !snapshot.config_error.empty()
                                  ? "the vehicle's file does not load"
                                  : "no vehicle file: what is missing cannot be told";
  const std::size_t problems = snapshot.problems.size();
  if (problems == 0) return vehicle + ": all is well\n";
  return fmt::format("{}: {} problem{}\n", vehicle, problems, problems == 1 ? "" : "s");
}

std::string drops_line(const ProcessView& process) {
  std::string line;
  for (const Drop& drop : process.drops) {
    line += fmt::format("{}{} {}", line.empty() ? "    dropped: " : ", ", drop.count, drop.reason);
    if (drop.per_s && *drop.per_s > 0) line += fmt::format(" (+{:.0f}/s)", *drop.per_s);
  }
  return line.empty() ? line : line + "\n";
}

/// "gvom 0.3.0, configuration 0123456789abcdef", as much of it as is known.
std::string build_line(const char* before, const std::string& version, const std::string& config_hash) {
  if (version.empty()) return "";
  return before + ("gvom " + version) + (config_hash.empty() ? "" : ", configuration " + config_hash) + "\n";
}

std::string ground_line(const GroundView& ground) {
  if (ground.sweeps == 0)
    return "    ground: not judged: too little of it is seen between 3 and 15 m around the vehicle\n";
  return fmt::format(
      "    ground: {}: {:.2f} m {} where it should be, tilted by {:.1f} degrees, in {} sweeps{}\n",
      to_string(ground.verdict), std::abs(ground.height_m), ground.height_m < 0 ? "below" : "above",
      tilt_degrees(ground), ground.sweeps, ground.on_the_way ? " on the way" : "");
}

std::string process_lines(const ProcessView& process, bool without_file) {
  std::optional<double> memory_mb;
  if (process.usage) memory_mb = static_cast<double>(process.usage->private_bytes) * 1e-6;
  std::string lines = fmt::format(
      "{:<24}{:<10}{:>9}{:>10}{:>10}{:>10}{:>10}\n", process.name, to_string(process.state),
      cell("{:.1f}/s", process.rate_hz), cell("{:.1f} s", process.health_age_s),
      cell("{:.2f} s", process.data_age_s), cell("{}", process.restarts), cell("{:.0f} MB", memory_mb));
  if (process.state != ProcessState::ok && !process.reason.empty()) lines += "    " + process.reason + "\n";
  if (!process.backend.empty())
    lines += fmt::format("    on {}: {}\n", process.backend, process.backend_details);
  if (process.ground) lines += ground_line(*process.ground);
  if (process.other_version || process.other_config || without_file)
    lines += build_line("    runs ", process.version, process.config_hash);
  return lines + drops_line(process);
}

std::string process_table(const Snapshot& snapshot) {
  std::string table = fmt::format("{:<24}{:<10}{:>9}{:>10}{:>10}{:>10}{:>10}\n", "process", "state", "rate",
                                  "heard", "data", "restarts", "memory");
  for (const ProcessView& process : snapshot.processes)
    table += process_lines(process, snapshot.config_hash.empty());
  return table;
}

std::string data_lines(const Snapshot& snapshot) {
  std::string lines;
  if (const auto& layers = snapshot.layers) {
    std::string missing;
    for (const LidarView& lidar : layers->lidars)
      if (lidar.missing) missing += (missing.empty() ? "" : ", ") + lidar.name;
    lines += fmt::format("layers: {:.2f} s old, published {:.2f} s ago, {} maps in the window, missing: {}\n",
                         layers->age_s, layers->publish_age_s, layers->maps_in_window,
                         missing.empty() ? "no lidar" : missing);
    for (const LidarView& lidar : layers->lidars)
      if (!lidar.missing && lidar.columns_seen_fraction < 1)
        lines += fmt::format("    the newest sweep of {} has {:.1f} % of its columns\n", lidar.name,
                             100 * lidar.columns_seen_fraction);
  } else {
    lines += "layers: none came\n";
  }
  if (snapshot.odometry)
    lines += fmt::format("odometry: {:.2f} s old, {}\n", snapshot.odometry->age_s,
                         cell("{:.1f}/s", snapshot.odometry->rate_hz));
  else
    lines += "odometry: none came\n";
  return lines + build_line("", snapshot.version, snapshot.config_hash);
}

std::string pool_table(const std::vector<ipc::PoolUse>& pools) {
  if (pools.empty()) return "";
  std::string table =
      fmt::format("{:<24}{:>10}{:>9}{:>14}\n", "pool: bytes of a chunk", "chunks", "used", "fewest free");
  for (const ipc::PoolUse& pool : pools)
    table +=
        fmt::format("{:<24}{:>10}{:>9}{:>14}\n", pool.chunk_bytes, pool.chunks, pool.used, pool.min_free);
  return table;
}

}  // namespace

std::string to_table(const Snapshot& snapshot) {
  std::string text = headline(snapshot);
  for (const std::string& problem : snapshot.problems) text += "  ! " + problem + "\n";
  text += "\n" + process_table(snapshot) + "\n" + data_lines(snapshot);
  const std::string pools = pool_table(snapshot.pools);
  return pools.empty() ? text : text + "\n" + pools;
}

}  // namespace gvom::ctl
