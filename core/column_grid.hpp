// The columns of a map as the layers' rules see them: with a margin of columns around the grid in which
// nothing is known, so that a look to the side needs no test for the edge.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/format/platform.hpp"

namespace gvom {

/// Width of the margin, columns: the farthest that a rule looks without asking where the grid ends.
inline constexpr std::int32_t kMargin = 8;

/// A height that is not known, where heights are compared: higher than all others.
inline constexpr float kNone_m = INFINITY;

struct ColumnGrid {
  std::int32_t n_xy;

  [[nodiscard]] GVOM_HD std::int32_t pitch() const { return n_xy + 2 * kMargin; }
  /// Of arrays over the grid and its margin.
  [[nodiscard]] GVOM_HD std::int32_t size() const { return pitch() * pitch(); }
  [[nodiscard]] GVOM_HD std::int32_t at(std::int32_t x, std::int32_t y) const {
    return (y + kMargin) * pitch() + x + kMargin;
  }
  [[nodiscard]] GVOM_HD std::int32_t x_of(std::int32_t at) const { return at % pitch() - kMargin; }
  [[nodiscard]] GVOM_HD std::int32_t y_of(std::int32_t at) const { return at / pitch() - kMargin; }
  [[nodiscard]] GVOM_HD bool contains(std::int32_t x, std::int32_t y) const {
    return x >= 0 && y >= 0 && x < n_xy && y < n_xy;
  }
};

/// What R9 finds in the columns, in arrays of `ColumnGrid::size()`.
struct GroundView {
  ColumnGrid grid;
  const float* lowest_ray_m;   ///< R5a: the lowest point at which a ray left the column, or kNone_m.
  const float* ground_m;       ///< Seen or assumed ground, or kNone_m.
  const std::uint8_t* is_rim;  ///< 1: ground that holes and hidden ground are judged by.
};

}  // namespace gvom
