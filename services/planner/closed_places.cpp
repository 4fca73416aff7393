#include "services/planner/closed_places.hpp"

#include <algorithm>

namespace gvom::planner {

ClosedPlaces::ClosedPlaces(int n_xy)
    : flags_(static_cast<std::size_t>(n_xy) * static_cast<std::size_t>(n_xy)) {
  middles_m_.reserve(kMost);
}

void ClosedPlaces::add(const Eigen::Vector2d& middle_m) {
  if (middles_m_.size() == kMost) middles_m_.erase(middles_m_.begin());
  middles_m_.push_back(middle_m);
}

MapView ClosedPlaces::close(const MapView& map) {
  if (empty()) return map;
  const Cells cells = map.cells();
  std::copy_n(map.flags, cells.count(), flags_.begin());
  const int reach = static_cast<int>(std::ceil(kRadius_m / cells.cell_m));
  for (const Eigen::Vector2d& middle_m : middles_m_) {
    const int x0 = static_cast<int>(std::floor((middle_m.x() - cells.x_m) / cells.cell_m));
    const int y0 = static_cast<int>(std::floor((middle_m.y() - cells.y_m) / cells.cell_m));
    for (int y = std::max(0, y0 - reach); y <= std::min(cells.n - 1, y0 + reach); ++y)
      for (int x = std::max(0, x0 - reach); x <= std::min(cells.n - 1, x0 + reach); ++x) {
        const int index = y * cells.n + x;
        if ((cells.center_of(index) - middle_m).norm() <= kRadius_m)
          flags_[static_cast<std::size_t>(index)] |= kHard;
      }
  }
  MapView closed = map;
  closed.flags = flags_.data();
  return closed;
}

}  // namespace gvom::planner
