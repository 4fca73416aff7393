#include "services/planner/soft_places.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/planner/disc.hpp"

namespace gvom::planner {

SoftPlaces::SoftPlaces(int n_xy) {
  const auto count = static_cast<std::size_t>(n_xy) * static_cast<std::size_t>(n_xy);
  for (auto* cells : {&states_, &before_, &flags_}) cells->resize(count);
}

void SoftPlaces::clear() {
  std::fill(states_.begin(), states_.end(), std::uint8_t{0});
}

void SoftPlaces::carry(const Cells& cells) {
  const auto columns = [&](double m) { return static_cast<int>(std::lround(m / cells.cell_m)); };
  const int dx = columns(cells.x_m - cells_.x_m), dy = columns(cells.y_m - cells_.y_m);
  if (cells.n == cells_.n && dx == 0 && dy == 0) return;
  std::swap(states_, before_);
  clear();
  if (cells.n == cells_.n && cells.cell_m == cells_.cell_m && std::abs(dx) < cells.n)
    for (int y = std::max(0, -dy); y < std::min(cells.n, cells.n - dy); ++y) {
      const int first = std::max(0, -dx), count = cells.n - std::abs(dx);
      std::copy_n(before_.begin() + (y + dy) * cells.n + first + dx, count,
                  states_.begin() + y * cells.n + first);
    }
  cells_ = cells;
}

bool SoftPlaces::was_soft(int cell) const {
  const int n = cells_.n;
  bool soft = false;
  for (int y = std::max(0, cell / n - 1); y <= std::min(n - 1, cell / n + 1); ++y)
    for (int x = std::max(0, cell % n - 1); x <= std::min(n - 1, cell % n + 1); ++x) {
      const std::uint8_t state = states_[static_cast<std::size_t>(y * n + x)];
      if (state == kWasHard) return false;
      soft = soft || state >= kSure;
    }
  return soft;
}

MapView SoftPlaces::soften(const MapView& map, const Eigen::Vector2d& vehicle_m) {
  const Cells cells = map.cells();
  carry(cells);
  std::copy_n(map.flags, cells.count(), flags_.begin());
  for (int y = 0, i = 0; y < cells.n; ++y) {
    const double dy_m = cells.y_m + (y + 0.5) * cells.cell_m - vehicle_m.y();
    const double square_m2 = kNear_m * kNear_m - dy_m * dy_m;
    const double half_m = square_m2 > 0 ? std::sqrt(square_m2) : -1;
    for (int x = 0; x < cells.n; ++x, ++i) {
      if (std::abs(cells.x_m + (x + 0.5) * cells.cell_m - vehicle_m.x()) <= half_m) continue;
      std::uint8_t& state = states_[static_cast<std::size_t>(i)];
      const bool soft = (map.flags[i] & kSoft) != 0;
      const auto counted = static_cast<std::uint8_t>(state < kSure ? state + 1 : kSure);
      state = (map.flags[i] & kHard) != 0 ? kWasHard : !soft ? 0 : state == kWasHard ? 1 : counted;
    }
  }
  DiscRows(cells, vehicle_m, kNear_m).for_each([&](int cell) {
    std::uint8_t& flags = flags_[static_cast<std::size_t>(cell)];
    if ((flags & kHard) != 0 && was_soft(cell)) flags = static_cast<std::uint8_t>((flags & ~kHard) | kSoft);
  });
  MapView softened = map;
  softened.flags = flags_.data();
  return softened;
}

}  // namespace gvom::planner
