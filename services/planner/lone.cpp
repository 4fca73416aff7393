#include "services/planner/lone.hpp"

namespace gvom::planner {
namespace {

constexpr double kSmallest_m2 = 0.1;  // less is a blade of grass

}  // namespace

std::optional<Eigen::Vector2d> lone_at(const MapView& map, const Eigen::Vector2d& place_m) {
  const Cells cells = map.cells();
  const auto stands = [&](int cell) { return (map.flags[cell] & kStands) != 0; };
  int standing = 0;
  Eigen::Vector2d middle_m(0, 0);
  DiscRows(cells, place_m, kPersonWide_m).for_each([&](int cell) {
    if (stands(cell)) middle_m += (cells.center_of(cell) - middle_m) / ++standing;
  });
  if (standing * cells.cell_m * cells.cell_m < kSmallest_m2) return std::nullopt;
  const double edge_m = kPersonWide_m / 2 + cells.cell_m;
  bool alone = true;
  DiscRows(cells, middle_m, kAlone_m).for_each([&](int cell) {
    if (stands(cell) && (cells.center_of(cell) - middle_m).norm() > edge_m) alone = false;
  });
  return alone ? std::optional(middle_m) : std::nullopt;
}

}  // namespace gvom::planner
