#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <linux/magic.h>

#include <cerrno>
#include <cstring>

#include "ipc/broker.hpp"
#include "ipc/broker_probe.hpp"
#include "services/common/bus/pool_spec.hpp"
#include "tools/ctl/check.hpp"
#include "tools/ctl/vehicle.hpp"

namespace gvom::ctl {

namespace {

Finding check_pools(const services::VehicleConfig& config) {
  const auto plan = ipc::plan_pools(services::pool_spec(config));
  if (!plan) return {Level::error, "pools", plan.error().message};
  const std::string size = fmt::format("{:.0f} MB of shared memory, {:.0f} MB of it in {} pools",
                                       static_cast<double>(ipc::shared_memory_bytes(*plan)) * 1e-6,
                                       static_cast<double>(plan->total_bytes) * 1e-6, plan->pools.size());
  if (const auto fits = ipc::check_space(*plan); !fits) return {Level::error, "pools", fits.error().message};
  return {Level::ok, "pools", size + ": /dev/shm has the room"};
}

Finding check_folder(const std::string& folder) {
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    return {Level::error, folder,
            fmt::format("user {} cannot write there: {}", ::geteuid(), std::strerror(errno))};
  struct statfs file_system {};
  const bool in_memory = ::statfs(folder.c_str(), &file_system) == 0 && file_system.f_type == TMPFS_MAGIC;
  if (folder == "/dev/shm" && !in_memory)
    return {Level::warning, folder, "is no tmpfs: maps would be written to a disk; mount one there"};
  return {Level::ok, folder, "can be written"};
}

/// The files that the bus's processes make, by name.
std::vector<std::string> bus_files(const services::VehicleConfig& config) {
  std::vector<std::string> files = {"/tmp/roudi", "/tmp/roudi.lock", "/tmp/iox-unique-roudi.lock",
                                    "/dev/shm/iceoryx_mgmt", "/dev/shm/gvom_doorbell"};
  for (const std::string& process : expected_of(config).processes) {
    files.push_back("/tmp/" + process);
    files.push_back("/tmp/" + process + ".lock");
  }
  return files;
}

/// Files of another user stop a process at its start, whether their owner lives or not.
Finding check_owners(const services::VehicleConfig& config) {
  std::string foreign;
  std::uint32_t owner = 0;
  for (const std::string& file : bus_files(config)) {
    struct stat status {};
    if (::lstat(file.c_str(), &status) != 0 || status.st_uid == ::geteuid()) continue;
    owner = status.st_uid;
    foreign += (foreign.empty() ? "" : " ") + file;
  }
  if (foreign.empty()) return {Level::ok, "owners", "no file of another user is in the way"};
  if (ipc::broker_pid())
    return {Level::warning, "owners",
            fmt::format("gvom runs as user {}: only that user's processes can join it, so check as that user",
                        owner)};
  return {
      Level::error, "owners",
      fmt::format("left by user {}, while this is user {}: check as the user of the services, or remove {}",
                  owner, ::geteuid(), foreign)};
}

}  // namespace

Findings check_memory(const services::VehicleConfig& config) {
  return {check_pools(config), check_folder("/dev/shm"), check_folder("/tmp"), check_owners(config)};
}

}  // namespace gvom::ctl
