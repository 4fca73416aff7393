// Negative obstacles (R13): the cone search from a column that was seen through, for host and device.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/platform.hpp"

namespace gvom {

/// An offset of this size, either sign: there is no defined height in the line.
inline constexpr std::int16_t kNoneInRow = INT16_MAX;

/// For every column the signed offset to the nearest defined height (0: its own), the smaller one on a
/// tie. With these the widening row of a search is one look: is the nearest within -i .. i?
struct NearestHeights {
  const std::int16_t* along_x;  ///< Within the column's row, [y][x].
  const std::int16_t* along_y;  ///< Within the column's x, [y][x].
};

/// The search of R13 in the direction (dx, dy), one of them 0: the height it finds, or NaN.
GVOM_HD inline float search_height(const float* height, const NearestHeights& nearest, std::int32_t n_xy,
                                   std::int32_t x, std::int32_t y, std::int32_t dx, std::int32_t dy,
                                   std::int32_t distance) {
  for (std::int32_t i = 1; i <= distance; ++i) {
    const std::int32_t cx = x + i * dx, cy = y + i * dy;
    if (cx < 0 || cx >= n_xy || cy < 0 || cy >= n_xy) break;
    const std::int32_t at = cy * n_xy + cx;
    const std::int32_t offset = dx != 0 ? nearest.along_y[at] : nearest.along_x[at];
    if (offset >= -i && offset <= i) return height[dx != 0 ? at + offset * n_xy : at + offset];
  }
  return NAN;
}

/// `negative_delta` of a column that was seen through (R13), metres.
GVOM_HD inline double negative_delta(const float* height, const NearestHeights& nearest, std::int32_t n_xy,
                                     std::int32_t x, std::int32_t y, float inferred_height,
                                     std::int32_t distance) {
  double highest = -INFINITY;
  double lowest = static_cast<double>(inferred_height);
  for (int direction = 0; direction < 4; ++direction) {
    const std::int32_t dx = direction == 0 ? 1 : direction == 1 ? -1 : 0;
    const std::int32_t dy = direction == 2 ? 1 : direction == 3 ? -1 : 0;
    const float found = search_height(height, nearest, n_xy, x, y, dx, dy, distance);
    if (std::isnan(found)) continue;
    highest = static_cast<double>(found) > highest ? static_cast<double>(found) : highest;
    lowest = static_cast<double>(found) < lowest ? static_cast<double>(found) : lowest;
  }
  return highest == -INFINITY ? 0 : highest - lowest;
}

}  // namespace gvom
