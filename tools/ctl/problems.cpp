// What of all that was seen is not as it should be, in words.
#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "tools/ctl/snapshot.hpp"

namespace gvom::ctl {

namespace {

constexpr double kLayersOld_s = std::chrono::duration<double>(ipc::kDefaultMaxAge).count();
constexpr double kOdometryOld_s = 2.0;   // 1 Hz is slow, but it is odometry
constexpr double kGroundsApart_m = 0.2;  // of two lidars at the same time and place
constexpr double kGroundsAngle_rad = 0.05;
constexpr double kSweepSeen_fraction = 0.95;  // as an ingest judges its packets

void add_problems(const ProcessView& process, const std::string& version,
                  std::vector<std::string>& problems) {
  if (process.state != ProcessState::ok && process.state != ProcessState::unknown)
    problems.push_back(fmt::format("{} is {}{}{}", process.name, to_string(process.state),
                                   process.reason.empty() ? "" : ": ", process.reason));
  if (process.other_version)
    problems.push_back(
        fmt::format("{} is of gvom {}, this is {}: restart it", process.name, process.version, version));
  if (process.other_config && process.name == kBroker)
    problems.push_back(
        fmt::format("{} has the pools of another configuration than the file's: restart it", process.name));
  else if (process.other_config)
    problems.push_back(
        fmt::format("{} runs with another configuration than the file's: gvomctl reload", process.name));
}

void add_problems(const LidarView& lidar, std::vector<std::string>& problems) {
  if (lidar.unknown)
    problems.push_back(
        fmt::format("lidar {} is not in gvom-fusion's configuration: its maps are not taken", lidar.name));
  else if (lidar.missing)
    problems.push_back(fmt::format("lidar {} is missing in the layers", lidar.name));
  else if (lidar.columns_seen_fraction < kSweepSeen_fraction)
    problems.push_back(fmt::format("lidar {}'s newest sweep has {:.0f} % of its columns", lidar.name,
                                   100 * lidar.columns_seen_fraction));
}

/// Two lidars that agree with the vehicle's file, on the way, but not with each other.
void compare_grounds(const std::vector<ProcessView>& processes, std::vector<std::string>& problems) {
  const auto is_comparable = [](const ProcessView& process) {
    return process.ground && process.ground->verdict == ipc::GroundVerdict::well &&
           process.ground->on_the_way;
  };
  for (auto a = processes.begin(); a != processes.end(); ++a)
    for (auto b = a + 1; b != processes.end(); ++b) {
      if (!is_comparable(*a) || !is_comparable(*b)) continue;
      const double apart_m = std::abs(a->ground->height_m - b->ground->height_m);
      const double angle_rad = std::atan(
          std::hypot(a->ground->slope_x - b->ground->slope_x, a->ground->slope_y - b->ground->slope_y));
      if (apart_m <= kGroundsApart_m && angle_rad <= kGroundsAngle_rad) continue;
      problems.push_back(
          fmt::format("{} and {} see the ground {:.1f} m and {:.0f} degrees apart: is a T_base_sensor wrong?",
                      tools::lidar_of(a->name), tools::lidar_of(b->name), apart_m, angle_rad * 180 / M_PI));
    }
}

}  // namespace

std::vector<std::string> problems_of(const Snapshot& snapshot) {
  std::vector<std::string> problems;
  if (!snapshot.config_error.empty())
    problems.push_back("the vehicle's file does not load, who is started anew will not run: " +
                       snapshot.config_error);
  for (const ProcessView& process : snapshot.processes) add_problems(process, snapshot.version, problems);
  compare_grounds(snapshot.processes, problems);
  for (const std::string& refusal : snapshot.refusals) problems.push_back(refusal);
  if (snapshot.broker.state != BrokerState::up) return problems;
  if (!snapshot.broker.joined) {
    problems.push_back("the bus cannot be joined" +
                       (snapshot.broker.note.empty() ? "" : ": " + snapshot.broker.note));
    return problems;
  }
  if (!snapshot.layers)
    problems.emplace_back("no layers came");
  else if (std::isinf(snapshot.layers->age_s))
    problems.emplace_back("the newest layers are " + ipc::age_words(ipc::kUnknownAge));
  else if (snapshot.layers->age_s > kLayersOld_s)
    problems.push_back(fmt::format("the newest layers are {:.1f} s old", snapshot.layers->age_s));
  if (snapshot.layers)
    for (const LidarView& lidar : snapshot.layers->lidars) add_problems(lidar, problems);
  if (!snapshot.odometry)
    problems.emplace_back("no odometry came");
  else if (snapshot.odometry->age_s > kOdometryOld_s)
    problems.push_back(fmt::format("the newest odometry is {:.1f} s old", snapshot.odometry->age_s));
  for (const ipc::PoolUse& pool : snapshot.pools)
    if (pool.used >= pool.chunks)
      problems.push_back(
          fmt::format("the pool of {} chunks of {} bytes is empty", pool.chunks, pool.chunk_bytes));
  return problems;
}

}  // namespace gvom::ctl
