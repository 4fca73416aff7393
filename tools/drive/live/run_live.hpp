// A session in real time from start to end: joins the bus, drives, leaves.
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "services/common/exit_code.hpp"
#include "tools/drive/live/live_session.hpp"

namespace gvom::driving {

struct LiveResult {
  SessionResult session;
  std::string figures;  ///< Of the simulation itself: was it in time?
};

/// Broker, fusion, ingests and planner must run or come; lidars' metadata are written to `folder` before the
/// bus is joined. A stop ends it like time that is over. The error is logged; the code to end with.
tl::expected<LiveResult, services::ExitCode> run_live(
    const CourseWorld& course, const services::VehicleConfig& config, const SessionOptions& options,
    const std::string& folder, services::Lifecycle& lifecycle, const Onlooker& onlooker);

}  // namespace gvom::driving
