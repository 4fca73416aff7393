// Negative obstacles (R13): the cone search from a column that was seen through, for host and device.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/format/platform.hpp"

namespace gvom {

/// An offset of this size, either sign: there is no defined height in the line.
inline constexpr std::int16_t kNoneInRow = INT16_MAX;

/// For every column the signed offset to the nearest defined height (0: its own), the smaller one on a
/// tie. With these the widening row of a search is one look: is the nearest within -i .. i?
struct NearestHeights {
  const std::int16_t* along_x;  ///< Within the column's row, [y][x].
  const std::int16_t* along_y;  ///< Within the column's x, [y][x].
};

/// Whether the nearest height of a line is within the search's width at distance `i`: within -i .. i.
GVOM_HD inline bool in_cone(std::int16_t offset, std::int16_t i) {
  const auto least = static_cast<std::int16_t>(-i);
  return (static_cast<int>(offset >= least) & static_cast<int>(offset <= i)) != 0;
}

/// The directions of the search, in this order.
inline constexpr int kDirections = 4;
GVOM_HD inline std::int32_t direction_x(int direction) {
  return direction == 0 ? 1 : direction == 1 ? -1 : 0;
}
GVOM_HD inline std::int32_t direction_y(int direction) {
  return direction == 2 ? 1 : direction == 3 ? -1 : 0;
}

/// The height that the search in a direction finds at distance `i`, where it is in the cone.
GVOM_HD inline float height_in_cone(const float* height, const NearestHeights& nearest, std::int32_t n_xy,
                                    std::int32_t column, int direction, std::int32_t i) {
  const std::int32_t dx = direction_x(direction), dy = direction_y(direction);
  const std::int32_t at = column + i * (dy * n_xy + dx);
  return height[dx != 0 ? at + nearest.along_y[at] * n_xy : at + nearest.along_x[at]];
}

/// At which distance the search of R13 in a direction finds a height, or 0.
GVOM_HD inline std::int32_t search_cone(const NearestHeights& nearest, std::int32_t n_xy, std::int32_t x,
                                        std::int32_t y, int direction, std::int32_t distance) {
  const std::int32_t dx = direction_x(direction), dy = direction_y(direction);
  for (std::int32_t i = 1; i <= distance; ++i) {
    const std::int32_t cx = x + i * dx, cy = y + i * dy;
    if (cx < 0 || cx >= n_xy || cy < 0 || cy >= n_xy) return 0;
    const std::int32_t at = cy * n_xy + cx;
    if (in_cone(dx != 0 ? nearest.along_y[at] : nearest.along_x[at], static_cast<std::int16_t>(i))) return i;
  }
  return 0;
}

/// `negative_delta` of a column that was seen through (R13), metres.
/// @param found distances of `search_cone` in the four directions
GVOM_HD inline double negative_delta(const float* height, const NearestHeights& nearest, std::int32_t n_xy,
                                     std::int32_t column, const std::int32_t (&found)[kDirections],
                                     float inferred_height) {
  double highest = -INFINITY;
  double lowest = static_cast<double>(inferred_height);
  for (int direction = 0; direction < kDirections; ++direction) {
    if (found[direction] == 0) continue;
    const auto rim =
        static_cast<double>(height_in_cone(height, nearest, n_xy, column, direction, found[direction]));
    highest = rim > highest ? rim : highest;
    lowest = rim < lowest ? rim : lowest;
  }
  return highest == -INFINITY ? 0 : highest - lowest;
}

}  // namespace gvom
