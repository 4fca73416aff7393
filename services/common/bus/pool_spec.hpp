// What of a vehicle's configuration decides the shared-memory pools: the same for the broker and all
// publishers.
#pragma once

#include <algorithm>

#include "ipc/pools.hpp"
#include "services/common/vehicle_config.hpp"

namespace gvom::services {

inline ipc::PoolSpec pool_spec(const VehicleConfig& config) {
  ipc::PoolSpec spec;
  spec.size_xy = config.mapper.map.size_xy;
  spec.size_z = config.mapper.map.size_z;
  spec.lidars = static_cast<int>(config.lidars.size());
  spec.buffer_size = config.mapper.window.buffer_size;
  spec.max_returns = 1;
  for (const LidarConfig& lidar : config.lidars)
    spec.max_returns = std::max(spec.max_returns, lidar.max_returns);
  spec.max_planners = config.ipc.max_planners;
  spec.voxel_map = config.fusion.voxel_rate_hz > 0.0;
  return spec;
}

}  // namespace gvom::services
