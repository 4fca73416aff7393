// What stands alone in a map, as a person may.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "services/planner/disc.hpp"

namespace gvom::planner {

inline constexpr std::uint8_t kStands = kHard | kSoft;
inline constexpr double kPersonWide_m = 0.8;
inline constexpr double kAlone_m = 1.2;  ///< So far around it nothing else stands.

struct Lone {
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  int columns = 0;
};

/// What stands at a place, HARD or SOFT columns within `kPersonWide_m`, with nothing else around it; nothing:
/// there is no such thing. Less than 0.1 m2 is grass.
std::optional<Lone> lone_at(const MapView& map, const Eigen::Vector2d& place_m);

/// Whether a column stands, and none of those before it in the map's order that touch it does.
inline bool begins_thing(const MapView& map, int cell) {
  const int n = map.cells().n, x = cell % n;
  const auto stands = [&](int at) { return (map.flags[at] & kStands) != 0; };
  if (!stands(cell) || (x > 0 && stands(cell - 1))) return false;
  if (cell < n) return true;
  return !stands(cell - n) && (x == 0 || !stands(cell - n - 1)) && (x == n - 1 || !stands(cell - n + 1));
}

/// Calls `visit(lone)` for each lone thing whose middle is no farther off; twice, or more often, for one
/// whose columns do not all touch.
template <class Visit>
void for_each_lone(const MapView& map, const Eigen::Vector2d& from_m, double radius_m, Visit&& visit) {
  const Cells cells = map.cells();
  DiscRows(cells, from_m, radius_m).for_each([&](int cell) {
    if (!begins_thing(map, cell)) return;
    if (const auto lone = lone_at(map, cells.center_of(cell))) visit(*lone);
  });
}

}  // namespace gvom::planner
