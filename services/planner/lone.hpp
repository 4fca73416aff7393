// What stands alone in a map, and is no larger than a person.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "services/planner/disc.hpp"

namespace gvom::planner {

inline constexpr std::uint8_t kStands = kHard | kSoft;
inline constexpr double kPersonWide_m = 0.8;
inline constexpr double kAlone_m = 1.2;  ///< So far around it nothing else stands.

/// The middle of what stands at a place, a HARD or SOFT column or more within `kPersonWide_m`, with nothing
/// else around it; nothing: there is no such thing. One column of grass is none.
std::optional<Eigen::Vector2d> lone_at(const MapView& map, const Eigen::Vector2d& place_m);

/// Whether a column stands, and none of those before it in the map's order that touch it does.
inline bool begins_thing(const MapView& map, int cell) {
  const int n = map.cells().n, x = cell % n;
  const auto stands = [&](int at) { return (map.flags[at] & kStands) != 0; };
  if (!stands(cell) || (x > 0 && stands(cell - 1))) return false;
  if (cell < n) return true;
  return !stands(cell - n) && (x == 0 || !stands(cell - n - 1)) && (x == n - 1 || !stands(cell - n + 1));
}

/// Calls `visit(middle_m)` for each lone thing whose middle is no farther off; twice, or more often, for one
/// whose columns do not all touch.
template <class Visit>
void for_each_lone(const MapView& map, const Eigen::Vector2d& from_m, double radius_m, Visit&& visit) {
  const Cells cells = map.cells();
  DiscRows(cells, from_m, radius_m).for_each([&](int cell) {
    if (!begins_thing(map, cell)) return;
    if (const auto middle_m = lone_at(map, cells.center_of(cell))) visit(*middle_m);
  });
}

}  // namespace gvom::planner
