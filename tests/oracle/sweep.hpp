// From a sweep to a buffer map (R1..R6), return by return and voxel by voxel.
#pragma once

#include <optional>
#include <vector>

#include "core/config.hpp"
#include "core/cpu/voxelizer.hpp"
#include "core/pose.hpp"
#include "core/sweep.hpp"
#include "tests/oracle/voxels.hpp"

namespace gvom::oracle {

struct BufferMap {
  int lidar = 0;
  std::int64_t stamp_ns = 0;
  Pose T_odom_base;
  Grid grid;
  std::vector<WorldVoxel> observed;
  ColumnHeights lowest_ray{Grid{}};  ///< R5a.
  FilterCounts filter;
};

/// The pose at a time between the first and the last of `odometry`, which is in order of time (R3).
std::optional<Pose> pose_at(const std::vector<StampedPose>& odometry, std::int64_t time_ns);

/// Nothing if a time of the sweep is not bracketed (R3).
std::optional<BufferMap> map_sweep(const MapperConfig& config, const LidarGeometry& lidar, const Sweep& sweep,
                                   const std::vector<StampedPose>& odometry);

}  // namespace gvom::oracle
