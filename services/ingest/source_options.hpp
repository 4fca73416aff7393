// What a lidar's keys ask of its source.
#pragma once

#include <cmath>

#include "services/common/vehicle_config.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

inline SourceOptions source_options(const services::LidarConfig& lidar) {
  return {lidar.min_sweep_fraction, static_cast<std::size_t>(lidar.max_returns),
          lidar.clock == services::LidarClock::arrival, std::llround(lidar.clock_offset_s * 1e9)};
}

}  // namespace gvom::ingest
