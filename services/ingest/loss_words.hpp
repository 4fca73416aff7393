// Why sweeps were not mapped, in words.
#pragma once

#include <string>
#include <vector>

#include "services/common/vehicle_config.hpp"
#include "services/common/words.hpp"
#include "services/ingest/odometry_intake.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

/// Of one sweep, without the numbers.
const char* words_of(SweepLoss why);

/// A line for each reason: how many sweeps, and the key or the times that decided.
std::vector<std::string> explain(const SweepLosses& losses, const OdometryIntake& odometry);

/// For Health: all sweeps are dropped, since they have `percent` of their columns.
void tell_dropped(double percent, const services::LidarConfig& lidar, services::Words& words);

/// For Health: all sweeps are of another mode or pace than the source says.
void tell_misfit(const services::LidarConfig& lidar, services::Words& words);

/// A line for each reason for which a source that is at its end gave fewer sweeps or returns than came to it,
/// and the key that decides.
std::vector<std::string> explain(const SourceCounters& counters, const services::LidarConfig& lidar);

}  // namespace gvom::ingest
