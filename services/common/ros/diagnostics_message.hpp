// The processes' Health as ROS's diagnostics.
#pragma once

#include <cstdint>
#include <vector>

#include "ipc/messages.hpp"

namespace gvom::ros {

/// How bad it is, as diagnostic_msgs/DiagnosticStatus has it.
enum class DiagnosticLevel : std::uint8_t { ok = 0, warn = 1, error = 2, stale = 3 };

/// A process is stale when it has been silent for longer.
inline constexpr std::int64_t kSilent_ns = 3'000'000'000;

/// Failed is an error; what starts, stops or is degraded a warning.
DiagnosticLevel level_of(const ipc::Health& health, std::int64_t now_mono_ns);

/// diagnostic_msgs/DiagnosticArray: a status for each process, its counters and stages as values. Replaces
/// what is in `out`.
void write_diagnostics(std::int64_t stamp_ns, const std::vector<ipc::Health>& processes,
                       std::int64_t now_mono_ns, std::vector<std::uint8_t>& out);

}  // namespace gvom::ros
