// Which bodies may be met where: a coarse grid over the plane, walked along a ray.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tools/sim/primitives.hpp"

namespace gvom::sim {

class BinGrid {
 public:
  static constexpr double kEdge = 3.2;  ///< Of a bin, metres.

  BinGrid() = default;
  explicit BinGrid(const std::vector<Primitive>& bodies);

  /// Calls `visit(index)` for bodies whose bin the ray passes no higher than they reach, nearest bins
  /// first, up to `limit_m` along the ray; `visit` may lower it. A body may be visited more than once.
  template <typename Visit>
  void walk(const Ray& ray, const double& limit_m, Visit&& visit) const;

  /// Calls `visit(index)` for the bodies whose box may hold a point over (x, y).
  template <typename Visit>
  void visit_over(double x_m, double y_m, Visit&& visit) const;

 private:
  struct Bin {
    std::size_t begin = 0;
    std::size_t end = 0;
    double top_m = -std::numeric_limits<double>::infinity();
  };

  [[nodiscard]] bool contains(int ix, int iy) const {
    return ix >= 0 && iy >= 0 && ix < width_ && iy < height_;
  }
  [[nodiscard]] const Bin& bin(int ix, int iy) const {
    return bins_[static_cast<std::size_t>(iy) * width_ + ix];
  }

  double min_x_m_ = 0.0;
  double min_y_m_ = 0.0;
  int width_ = 0;
  int height_ = 0;
  std::vector<Bin> bins_;
  std::vector<int> members_;
};

template <typename Visit>
void BinGrid::walk(const Ray& ray, const double& limit_m, Visit&& visit) const {
  const double x = (ray.origin.x() - min_x_m_) / kEdge;
  const double y = (ray.origin.y() - min_y_m_) / kEdge;
  const double dx = ray.direction.x() / kEdge;
  const double dy = ray.direction.y() / kEdge;
  int ix = static_cast<int>(std::floor(x));
  int iy = static_cast<int>(std::floor(y));
  const int step_x = dx < 0.0 ? -1 : 1;
  const int step_y = dy < 0.0 ? -1 : 1;
  const double per_x = 1.0 / std::max(std::abs(dx), 1e-12);
  const double per_y = 1.0 / std::max(std::abs(dy), 1e-12);
  double next_x = (dx < 0.0 ? x - ix : ix + 1 - x) * per_x;
  double next_y = (dy < 0.0 ? y - iy : iy + 1 - y) * per_y;
  double distance = 0.0;
  while (distance < limit_m) {
    const double leave = std::min(next_x, next_y);
    if (contains(ix, iy)) {
      const Bin& here = bin(ix, iy);
      const double lowest =
          ray.origin.z() +
          ray.direction.z() * (ray.direction.z() < 0.0 ? std::min(leave, limit_m) : distance);
      if (lowest <= here.top_m)
        for (std::size_t i = here.begin; i < here.end; ++i) visit(members_[i]);
    }
    const bool gone = (step_x < 0 ? ix < 0 : ix >= width_) || (step_y < 0 ? iy < 0 : iy >= height_);
    if (gone) return;
    distance = leave;
    if (next_x < next_y) {
      ix += step_x;
      next_x += per_x;
    } else {
      iy += step_y;
      next_y += per_y;
    }
  }
}

template <typename Visit>
void BinGrid::visit_over(double x_m, double y_m, Visit&& visit) const {
  const int ix = static_cast<int>(std::floor((x_m - min_x_m_) / kEdge));
  const int iy = static_cast<int>(std::floor((y_m - min_y_m_) / kEdge));
  if (!contains(ix, iy)) return;
  for (std::size_t i = bin(ix, iy).begin; i < bin(ix, iy).end; ++i) visit(members_[i]);
}

}  // namespace gvom::sim
