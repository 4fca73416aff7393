// The cells of a map within a distance of a place.
#pragma once

#include <algorithm>

#include "services/planner/map_view.hpp"

namespace gvom::planner {

class DiscRows {
 public:
  DiscRows(const Cells& cells, const Eigen::Vector2d& middle_m, double radius_m)
      : cells_(cells), middle_m_(middle_m), radius_m_(radius_m) {}

  /// Calls `visit(index)` for those whose middle is no farther off.
  template <class Visit>
  void for_each(Visit&& visit) const {
    const int reach = static_cast<int>(std::ceil(radius_m_ / cells_.cell_m));
    const int x0 = static_cast<int>(std::floor((middle_m_.x() - cells_.x_m) / cells_.cell_m));
    const int y0 = static_cast<int>(std::floor((middle_m_.y() - cells_.y_m) / cells_.cell_m));
    for (int y = std::max(0, y0 - reach); y <= std::min(cells_.n - 1, y0 + reach); ++y)
      for (int x = std::max(0, x0 - reach); x <= std::min(cells_.n - 1, x0 + reach); ++x) {
        const int index = y * cells_.n + x;
        if ((cells_.center_of(index) - middle_m_).squaredNorm() <= radius_m_ * radius_m_) visit(index);
      }
  }

 private:
  Cells cells_;
  Eigen::Vector2d middle_m_;
  double radius_m_;
};

}  // namespace gvom::planner
