#include "services/planner/kept_places.hpp"

#include <algorithm>

#include "services/planner/disc.hpp"

namespace gvom::planner {
namespace {

constexpr std::uint8_t kHoles = kNegative | kSteep, kLethal = kHoles | kHard;

bool is_seen(std::uint8_t visibility) {
  return visibility == static_cast<std::uint8_t>(Visibility::ground_seen);
}

}  // namespace

KeptPlaces::KeptPlaces(int n_xy, double blind_m)
    : near_m_(blind_m + kBeyond_m),
      lethal_(n_xy),
      stood_(n_xy),
      flags_(static_cast<std::size_t>(n_xy) * n_xy) {}

void KeptPlaces::count(const MapView& map) {
  constexpr std::int64_t kMost = kStood_ns / kTick_ns;
  const std::int64_t ticks =
      std::max<std::int64_t>((map.stamp_ns - counted_ns_.value_or(map.stamp_ns)) / kTick_ns, 0);
  counted_ns_ = counted_ns_.value_or(map.stamp_ns) + ticks * kTick_ns;
  for (int cell = 0; cell < map.cells().count(); ++cell) {
    const bool hard = (map.flags[cell] & kHard) != 0;
    stood_[cell] = hard ? static_cast<std::uint8_t>(std::min(stood_[cell] + ticks, kMost)) : 0;
  }
}

MapView KeptPlaces::keep(const MapView& map, const Eigen::Vector2d& vehicle_m) {
  const Cells cells = map.cells();
  lethal_.carry(cells);
  stood_.carry(cells);
  count(map);
  std::copy_n(map.flags, cells.count(), flags_.begin());
  DiscRows(cells, vehicle_m, near_m_).for_each([&](int cell) {
    std::uint8_t& kept = lethal_[cell];
    const std::uint8_t keeps = stood_[cell] >= kStood_ns / kTick_ns ? kLethal : kHoles;
    kept |= map.flags[cell] & keeps;
    if (is_seen(map.visibility[cell])) kept &= map.flags[cell];
    flags_[static_cast<std::size_t>(cell)] |= kept;
  });
  const double square_m2 = near_m_ * near_m_;
  for (int cell = 0; cell < cells.count(); ++cell)
    if ((cells.center_of(cell) - vehicle_m).squaredNorm() > square_m2)
      lethal_[cell] = map.flags[cell] & kLethal;
  MapView with = map;
  with.flags = flags_.data();
  return with;
}

}  // namespace gvom::planner
