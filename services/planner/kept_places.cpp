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
      flags_(static_cast<std::size_t>(n_xy) * n_xy),
      holes_(flags_.size()) {}

void KeptPlaces::count(const MapView& map) {
  const std::int64_t passed_ns = map.stamp_ns - counted_ns_.value_or(map.stamp_ns);
  const auto passed = static_cast<int>(std::clamp<std::int64_t>(passed_ns / kTick_ns, 0, kHolds));
  const int ticks = std::min(passed, static_cast<int>(kMostTicks));
  counted_ns_ =
      passed_ns < 0 ? map.stamp_ns : counted_ns_.value_or(map.stamp_ns) + passed_ns / kTick_ns * kTick_ns;
  for (int cell = 0; cell < map.cells().count(); ++cell) {
    const bool hard = (map.flags[cell] & kHard) != 0;
    const int hard_for = stood_[cell] + ticks, held_for = stood_[cell] - passed;
    const bool holds = held_for > kStood && !is_seen(map.visibility[cell]);
    const int stood = !hard ? (holds ? held_for : 0) : hard_for >= kStood ? kStood + kHolds : hard_for;
    stood_[cell] = static_cast<std::uint8_t>(stood);
  }
}

MapView KeptPlaces::keep(const MapView& map, const Eigen::Vector2d& vehicle_m) {
  const Cells cells = map.cells();
  lethal_.carry(cells);
  stood_.carry(cells);
  count(map);
  std::copy_n(map.flags, cells.count(), flags_.begin());
  std::copy_n(map.flags, cells.count(), holes_.begin());
  DiscRows(cells, vehicle_m, near_m_).for_each([&](int cell) {
    std::uint8_t& kept = lethal_[cell];
    kept |= map.flags[cell] & kHoles;
    if (is_seen(map.visibility[cell])) kept &= map.flags[cell];
    const auto at = static_cast<std::size_t>(cell);
    holes_[at] |= kept & kHoles;
    flags_[at] |= kept;
    if (stood_[cell] > kStood) flags_[at] |= kHard;
  });
  const double square_m2 = near_m_ * near_m_;
  for (int cell = 0; cell < cells.count(); ++cell)
    if ((cells.center_of(cell) - vehicle_m).squaredNorm() > square_m2)
      lethal_[cell] = map.flags[cell] & kLethal;
  return with_flags(map, flags_);
}

MapView KeptPlaces::holes(const MapView& map) const {
  return with_flags(map, holes_);
}

}  // namespace gvom::planner
