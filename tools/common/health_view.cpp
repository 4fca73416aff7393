#include "tools/common/health_view.hpp"

#include <algorithm>

#include "ipc/text.hpp"

namespace gvom::tools {

Counters counters_of(const ipc::Health& health) {
  Counters counters;
  const auto count = std::min<std::uint32_t>(health.counter_count, ipc::Health::kMaxCounters);
  for (std::uint32_t i = 0; i < count; ++i)
    counters.emplace_back(ipc::text_of(health.counters[i].name), health.counters[i].value);
  return counters;
}

bool is_drop(const std::string& counter) {
  return counter.compare(0, 5, "drop_") == 0 || counter == "odometry_lost" || counter == "maps_lost";
}

const char* to_string(ipc::HealthState state) {
  switch (state) {
    case ipc::HealthState::starting:
      return "starting";
    case ipc::HealthState::ok:
      return "ok";
    case ipc::HealthState::degraded:
      return "degraded";
    case ipc::HealthState::failed:
      return "failed";
    case ipc::HealthState::stopping:
      return "stopping";
  }
  return "unknown";
}

std::string lidar_of(const std::string& process) {
  constexpr std::size_t kLength = sizeof(kIngestPrefix) - 1;
  return process.compare(0, kLength, kIngestPrefix) == 0 ? process.substr(kLength) : "";
}

}  // namespace gvom::tools
