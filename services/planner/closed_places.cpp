#include "services/planner/closed_places.hpp"

#include <algorithm>

#include "services/planner/disc.hpp"

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
  for (const Eigen::Vector2d& middle_m : middles_m_)
    DiscRows(cells, middle_m, kRadius_m).for_each([&](int cell) {
      flags_[static_cast<std::size_t>(cell)] |= kHard;
    });
  return with_flags(map, flags_);
}

}  // namespace gvom::planner
