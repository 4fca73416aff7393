#include "services/planner/lone.hpp"

namespace gvom::planner {
namespace {

constexpr double kSmallest_m2 = 0.1;
constexpr double kLargest_m2 = 1.2;  // more does not fit in the disc that is looked at

}  // namespace

std::optional<Lone> lone_at(const MapView& map, const Eigen::Vector2d& place_m) {
  const Cells cells = map.cells();
  const auto stands = [&](int cell) { return (map.flags[cell] & kStands) != 0; };
  Lone lone;
  DiscRows(cells, place_m, kPersonWide_m).for_each([&](int cell) {
    if (stands(cell)) lone.middle_m += (cells.center_of(cell) - lone.middle_m) / ++lone.columns;
  });
  const double area_m2 = lone.columns * cells.cell_m * cells.cell_m;
  if (area_m2 < kSmallest_m2 || area_m2 > kLargest_m2) return std::nullopt;
  const double edge_m = kPersonWide_m / 2 + cells.cell_m;
  bool alone = true;
  DiscRows(cells, lone.middle_m, kAlone_m).for_each([&](int cell) {
    if (stands(cell) && (cells.center_of(cell) - lone.middle_m).norm() > edge_m) alone = false;
  });
  return alone ? std::optional(lone) : std::nullopt;
}

}  // namespace gvom::planner
