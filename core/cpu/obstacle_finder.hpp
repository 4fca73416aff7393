// Obstacles of all columns (R11, R14) on the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "core/obstacle.hpp"

namespace gvom::cpu {

class ObstacleFinder {
 public:
  explicit ObstacleFinder(std::int32_t n_xy) : sums_(static_cast<std::size_t>(ColumnGrid{n_xy}.size())) {}

  /// Reads `height`; writes `obstacle_density`, `clearance` and the flags HARD and SOFT.
  void find(const FusedView& map, const ColumnParameters& p, const GroundView& ground,
            const LayerArrays& out);

 private:
  void read_columns(const FusedView& map, const ColumnParameters& p, const ColumnGrid& grid,
                    const LayerArrays& out);

  std::vector<ObstacleSums> sums_;  // nothing in the margin
};

}  // namespace gvom::cpu
