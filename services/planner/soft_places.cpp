#include "services/planner/soft_places.hpp"

#include <algorithm>
#include <cmath>

#include "services/planner/disc.hpp"

namespace gvom::planner {

SoftPlaces::SoftPlaces(int n_xy, double near_m)
    : near_m_(near_m), states_(n_xy), flags_(static_cast<std::size_t>(n_xy) * n_xy) {}

bool SoftPlaces::was_soft(int cell) const {
  const int n = states_.cells().n;
  bool soft = false;
  for (int y = std::max(0, cell / n - 1); y <= std::min(n - 1, cell / n + 1); ++y)
    for (int x = std::max(0, cell % n - 1); x <= std::min(n - 1, cell % n + 1); ++x) {
      const std::uint8_t state = states_[y * n + x];
      if (state == kWasHard) return false;
      soft = soft || state >= kSure;
    }
  return soft;
}

void SoftPlaces::count(const MapView& map, const Eigen::Vector2d& vehicle_m) {
  const Cells cells = map.cells();
  for (int y = 0, i = 0; y < cells.n; ++y) {
    const double dy_m = cells.y_m + (y + 0.5) * cells.cell_m - vehicle_m.y();
    const double square_m2 = near_m_ * near_m_ - dy_m * dy_m;
    const double half_m = square_m2 > 0 ? std::sqrt(square_m2) : -1;
    for (int x = 0; x < cells.n; ++x, ++i) {
      if (std::abs(cells.x_m + (x + 0.5) * cells.cell_m - vehicle_m.x()) <= half_m) continue;
      std::uint8_t& state = states_[i];
      const bool soft = (map.flags[i] & kSoft) != 0;
      const auto counted = static_cast<std::uint8_t>(state < kSure ? state + 1 : kSure);
      state = (map.flags[i] & kHard) != 0 ? kWasHard : !soft ? 0 : state == kWasHard ? 1 : counted;
    }
  }
}

MapView SoftPlaces::soften(const MapView& map, const MapView& seen, const Eigen::Vector2d& vehicle_m) {
  const Cells cells = map.cells();
  states_.carry(cells);
  if (counted_ns_ != map.stamp_ns) count(seen, vehicle_m);
  counted_ns_ = map.stamp_ns;
  std::copy_n(map.flags, cells.count(), flags_.begin());
  DiscRows(cells, vehicle_m, near_m_).for_each([&](int cell) {
    std::uint8_t& flags = flags_[static_cast<std::size_t>(cell)];
    if ((flags & kHard) != 0 && was_soft(cell)) flags = static_cast<std::uint8_t>((flags & ~kHard) | kSoft);
  });
  return with_flags(map, flags_);
}

}  // namespace gvom::planner
