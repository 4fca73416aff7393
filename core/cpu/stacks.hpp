// Columns in the order in which their voxels lie in memory.
#pragma once

#include <cstdint>

#include "core/format/grid.hpp"

namespace gvom::cpu {

/// Calls `visit(x, y)` for all columns, one stack of bricks after the other.
template <class Visit>
void for_each_by_stacks(std::int32_t n_xy, Visit&& visit) {
  for (std::int32_t y0 = 0; y0 < n_xy; y0 += kBrickEdge)
    for (std::int32_t x0 = 0; x0 < n_xy; x0 += kBrickEdge)
      for (std::int32_t y = y0; y < y0 + kBrickEdge; ++y)
        for (std::int32_t x = x0; x < x0 + kBrickEdge; ++x) visit(x, y);
}

}  // namespace gvom::cpu
