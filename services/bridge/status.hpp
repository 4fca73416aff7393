// What the page tells of the whole: /gvom/status.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ipc/freshness.hpp"
#include "ipc/messages.hpp"

namespace gvom::bridge {

/// What was heard last.
struct Heard {
  std::string vehicle;
  std::vector<ipc::Health> processes;  ///< Of each its newest.
  std::optional<ipc::Layers> layers;   ///< Without their arrays.
  std::optional<ipc::Odometry> odometry;
  std::int64_t odometry_mono_ns = 0;  ///< When that came.
};

/// JSON: `vehicle`, `version`; `layers` (age_s, publish_age_s, maps_in_window, stamp_ns) and `odometry`
/// (age_s, stamp_ns), null before the first; `lidars`, a list of name, missing, unknown, age_s,
/// columns_seen_fraction, maps_in_window, maps_received, maps_lost; `processes`, a list of name, state,
/// reason, version, backend, rate_hz, heard_s, stages (p50_ms, p99_ms, max_ms by name), counters and drops
/// (counts by name). What is not known is null. A process that is silent for over 3 s is `silent`.
std::string status_json(const Heard& heard, const ipc::Moment& now);

}  // namespace gvom::bridge
