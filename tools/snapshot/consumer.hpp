// The planner's side: takes layers from the bus and writes them.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "ipc/planner.hpp"
#include "services/common/exit_code.hpp"
#include "services/common/lifecycle.hpp"
#include "tools/snapshot/output.hpp"

namespace gvom::snapshot {

/// When pictures are written.
struct Schedule {
  bool once = true;                                ///< The first layers, then end.
  std::optional<std::chrono::milliseconds> every;  ///< At this interval, and the newest at the stop.
  std::chrono::milliseconds timeout{10'000};       ///< `once`: longest wait for the first layers.
};

/// A view of the sample: valid while it lives.
LayersPicture picture_of(const ipc::LayersSample& sample, const std::string& vehicle);

/// Runs until the schedule is done or a stop is asked for; says on the log what it wrote, its age, and what
/// was lost. try_again: no layers in time, or the broker is gone; unavailable: a file cannot be written.
services::ExitCode consume(ipc::PlannerClient& client, services::Lifecycle& lifecycle,
                           const Schedule& schedule, const std::string& vehicle, Output& output);

}  // namespace gvom::snapshot
