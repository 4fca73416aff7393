// The grid of a map around the vehicle (R1).
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/config.hpp"
#include "core/format/grid.hpp"

namespace gvom {

/// The grid of a map made with the vehicle at `base_position_m` in odom (R1).
inline Grid grid_around(const MapConfig& config, const Eigen::Vector3d& base_position_m) {
  Grid grid;
  grid.size = {config.size_xy, config.size_xy, config.size_z};
  grid.resolution_m = {config.resolution_xy_m, config.resolution_xy_m, config.resolution_z_m};
  for (int a = 0; a < 3; ++a) {
    const double voxel = std::floor(voxel_coordinate(base_position_m[a], grid.resolution_m[a]));
    grid.origin[a] = floor_to_brick(static_cast<std::int32_t>(voxel) - grid.size[a] / 2);
  }
  return grid;
}

}  // namespace gvom
