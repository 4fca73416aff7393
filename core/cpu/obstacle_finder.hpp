// Obstacles of all columns (R11, R14) on the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cpu/window_maps.hpp"
#include "core/obstacle.hpp"

namespace gvom::cpu {

class ObstacleFinder {
 public:
  explicit ObstacleFinder(std::int32_t n_xy);

  /// Reads `height` and `visibility`; writes `obstacle_density`, `clearance` and the flags HARD and SOFT.
  void find(const FusedView& map, const WindowMaps& maps, const ColumnParameters& p, const GroundView& ground,
            const LayerArrays& out);

 private:
  void read_columns(const FusedView& map, const WindowMaps& maps, const ColumnParameters& p,
                    const ColumnGrid& grid, const LayerArrays& out);

  std::vector<ObstacleSums> sums_;      // nothing in the margin
  std::vector<std::uint8_t> lowest_;    // obstacle voxel
  std::vector<std::uint8_t> low_;       // 1: the column has low hits
  std::vector<std::uint8_t> low_near_;  // of a row: one of the 3 x 3 columns has
};

}  // namespace gvom::cpu
