// How far it is from each cell to the nearest marked one.
#pragma once

#include <cstdint>
#include <vector>

namespace gvom::planner {

/// The exact Euclidean distance transform in two passes (Felzenszwalb and Huttenlocher, Distance Transforms
/// of Sampled Functions, 2012): along columns by counting, along rows by the lower envelope of parabolas.
class DistanceTransform {
 public:
  static constexpr float kFar_m = 1e6F;  ///< Where nothing is marked.

  /// @param n_xy the largest map, cells along an edge
  explicit DistanceTransform(int n_xy);

  /// @param marked n * n cells, [y][x], 0 or 1
  /// @param distance_m n * n, between the cells' middles, metres
  void run(const std::uint8_t* marked, int n, double cell_m, float* distance_m);

 private:
  void count_rows(const std::uint8_t* marked, int n);
  /// One row of squared distances, in cells; false: none is marked.
  bool square_row(const std::int32_t* rows, int n);

  std::vector<std::int32_t> rows_;  ///< To the nearest marked cell of the same column.
  std::vector<std::int32_t> squared_;
  std::vector<std::int32_t> apexes_;  ///< Of the parabolas of the envelope, from left to right.
  std::vector<double> begins_;        ///< Where each parabola is the lowest from.
};

}  // namespace gvom::planner
