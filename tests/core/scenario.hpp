// Random drives: a configuration, odometry, and sweeps of several lidars in the order in which they arrive.
#pragma once

#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "core/pose.hpp"
#include "core/sweep.hpp"

namespace gvom::test {

struct Arrival {
  int lidar;
  Sweep sweep;
};

struct Scenario {
  MapperConfig config;
  std::vector<LidarGeometry> lidars;
  std::vector<StampedPose> odometry;
  std::vector<Arrival> arrivals;  ///< Not in order of stamps; some twice, some not bracketed by odometry.
};

struct ScenarioSize {
  int size_xy;
  int size_z;
  int sweeps;
  int returns;  ///< Of a sweep.
  /// Everything on whole and half voxels: rays along axes and diagonals, through edges and corners; also of
  /// edges such as 0.4 m, where a division and a product with the reciprocal name different voxels (R1).
  bool on_faces;
  /// Up to so long maps that left the window are remembered (R17); 0: they are not.
  double max_memory_s = 0;
  std::int64_t tick_ns = 100'000'000;  ///< From sweep to sweep of the fastest lidar.
};

Scenario random_scenario(std::uint64_t seed, const ScenarioSize& size);

}  // namespace gvom::test
