// What Health messages say, as the tools that show them need it.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "ipc/messages.hpp"

namespace gvom::tools {

inline constexpr char kIngestPrefix[] = "gvom-ingest-";  // of a lidar's process

using Counters = std::vector<std::pair<std::string, std::uint64_t>>;

/// In the process's order.
Counters counters_of(const ipc::Health& health);

/// Whether a counter of that name counts what was dropped or lost.
bool is_drop(const std::string& counter);

/// "starting", "ok", ...; "unknown" for a number that is none.
const char* to_string(ipc::HealthState state);

/// "gvom-ingest-front" -> "front"; empty if it is no lidar's process.
std::string lidar_of(const std::string& process);

}  // namespace gvom::tools
