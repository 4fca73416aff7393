// Why sweeps were not mapped, in words.
#pragma once

#include <string>
#include <vector>

#include "services/ingest/odometry_intake.hpp"

namespace gvom::ingest {

/// Of one sweep, without the numbers.
const char* words_of(SweepLoss why);

/// A line for each reason: how many sweeps, and the key or the times that decided.
std::vector<std::string> explain(const SweepLosses& losses, const OdometryIntake& odometry);

}  // namespace gvom::ingest
