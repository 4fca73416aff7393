// What is really there, column by column, on the map's own grid.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/sim/recording.hpp"

namespace gvom::sim {

/// All layers are indexed [y][x] and cover the world's truth area.
struct GroundTruth {
  double resolution_m;
  std::int64_t origin[2];  ///< World voxel (R1) of column (0, 0).
  int size_x;
  int size_y;
  std::vector<float> ground_lowest;  ///< Of the ground within the column, metres in odom.
  std::vector<float> ground_mean;
  std::vector<float> ditch_depth;  ///< The deepest within the column, metres; 0 where there is no ditch.
  std::vector<float>
      clearance;  ///< The lowest thing overhead, above the lowest ground, metres; else +infinity.
  std::vector<std::uint8_t> classes;  ///< `ObjectClass`.
  std::vector<std::int32_t> object;   ///< Number of the object that gave the class, -1: none.
};

/// Samples the world every 5 cm. The columns through which the person walks are `ObjectClass::person`.
GroundTruth sample_truth(const Scene& scene, double resolution_m);

/// Writes the layers as .npy and `truth.json`. Errors name the file.
tl::expected<void, std::string> write_truth(const Scene& scene, const GroundTruth& truth,
                                            const std::string& directory);

}  // namespace gvom::sim
