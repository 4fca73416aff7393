#include "services/planner/carried_cells.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gvom::planner {

CarriedCells::CarriedCells(int n_xy)
    : values_(static_cast<std::size_t>(n_xy) * static_cast<std::size_t>(n_xy)), before_(values_.size()) {}

void CarriedCells::clear() {
  std::fill(values_.begin(), values_.end(), std::uint8_t{0});
}

void CarriedCells::carry(const Cells& cells) {
  const auto columns = [&](double m) { return static_cast<int>(std::lround(m / cells.cell_m)); };
  const int dx = columns(cells.x_m - cells_.x_m), dy = columns(cells.y_m - cells_.y_m);
  if (cells.n == cells_.n && dx == 0 && dy == 0) return;
  std::swap(values_, before_);
  clear();
  if (cells.n == cells_.n && cells.cell_m == cells_.cell_m && std::abs(dx) < cells.n)
    for (int y = std::max(0, -dy); y < std::min(cells.n, cells.n - dy); ++y) {
      const int first = std::max(0, -dx), count = cells.n - std::abs(dx);
      std::copy_n(before_.begin() + (y + dy) * cells.n + first + dx, count,
                  values_.begin() + y * cells.n + first);
    }
  cells_ = cells;
}

}  // namespace gvom::planner
