#include "core/cpu/negative_finder.hpp"

namespace gvom::cpu {

void NegativeFinder::find(const ColumnParameters& p, const GroundView& ground, const LayerArrays& out) {
  const ColumnGrid& grid = ground.grid;
  const HoleParameters holes = hole_parameters(p);
  for (std::int32_t y = 0, i = 0; y < grid.n_xy; ++y)
    for (std::int32_t x = 0; x < grid.n_xy; ++x, ++i) {
      const std::int32_t at = grid.at(x, y);
      double depth_m = 0;
      if (may_hide_hole(ground, at)) depth_m = HoleSearch(ground, holes, x, y).depth_m();
      out.negative_delta[i] = static_cast<float>(depth_m);
      shows_[static_cast<std::size_t>(at)] = depth_m > 0 ? 1 : 0;
    }
  for (std::int32_t y = 0, i = 0; y < grid.n_xy; ++y)
    for (std::int32_t x = 0; x < grid.n_xy; ++x, ++i)
      if (is_negative(grid, shows_.data() + grid.at(x, y))) out.flags[i] |= kNegative;
}

}  // namespace gvom::cpu
