// Slope and roughness of all columns (R12) on the CPU, a row of columns at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "core/column.hpp"
#include "core/format/layers.hpp"
#include "core/plane.hpp"

namespace gvom::cpu {

/// PlaneSums of a row of columns, number by number.
struct SumRows {
  std::int32_t *n, *x, *y, *xx, *xy, *yy;
  double *z, *xz, *yz;
};

/// PlaneFit of a row of columns, and the sums of squared residuals.
struct FitRows {
  double *a, *b, *c, *squares_m2;
  std::int32_t* defined;
};

class PlaneFitter {
 public:
  /// @param plane_size N of the N x N columns, odd
  PlaneFitter(std::int32_t n_xy, std::int32_t plane_size);

  PlaneFitter(const PlaneFitter&) = delete;
  PlaneFitter& operator=(const PlaneFitter&) = delete;

  /// Reads `height` where there is seen or assumed ground; writes `slope_x`, `slope_y`, `slope`, `roughness`
  /// and the flag STEEP.
  void fit(const ColumnParameters& p, const GroundView& ground, const LayerArrays& out);

 private:
  // The sums of a row, whose heights begin at `centre_m`.
  void add_up(const float* centre_m, std::ptrdiff_t width);

  std::int32_t n_xy_;
  std::int32_t radius_;
  // The rows of heights around the one in work, with undefined ones beyond the grid's edges.
  std::vector<float> padded_;
  std::vector<std::int32_t> integers_;  // what sums_ and fits_ point to
  std::vector<double> doubles_;
  SumRows sums_;
  FitRows fits_;
};

}  // namespace gvom::cpu
