// Layers of level, seen, smooth ground, to be changed cell by cell.
#pragma once

#include <vector>

#include "services/planner/map_view.hpp"
#include "tests/core/random.hpp"

namespace gvom::test {

/// n * n columns of 0.4 m, [y][x], the lower corner at (0, 0) in odom: cell (x, y) has its middle at
/// ((x + 0.5) 0.4 m, (y + 0.5) 0.4 m).
struct FlatMap {
  static constexpr double kCell_m = 0.4;

  int n;
  Grid grid;
  std::vector<float> height, slope, roughness, clearance;
  std::vector<std::uint8_t> flags, visibility;

  explicit FlatMap(int edge);

  [[nodiscard]] int at(int x, int y) const { return y * n + x; }
  /// From x0, y0 to x1, y1, both included.
  void flag(int x0, int y0, int x1, int y1, std::uint8_t bits);
  void forget(int x, int y);  ///< Nothing is known of the column.
  [[nodiscard]] Eigen::Vector2d middle_m(int x, int y) const;
  [[nodiscard]] planner::MapView view() const;
};

/// Trunks, soft and steep places, slopes and unknown ground, all by chance.
FlatMap random_map(Random& random, int edge, double trunks);

}  // namespace gvom::test
