#include "core/cpu/obstacle_finder.hpp"

namespace gvom::cpu {

void ObstacleFinder::read_columns(const FusedView& map, const ColumnParameters& p, const ColumnGrid& grid,
                                  const LayerArrays& out) {
  for (std::int32_t y = 0, i = 0; y < grid.n_xy; ++y)
    for (std::int32_t x = 0; x < grid.n_xy; ++x, ++i) {
      ObstacleSums& sums = sums_[static_cast<std::size_t>(grid.at(x, y))];
      sums = {};
      out.obstacle_density[i] = out.clearance[i] = kUnknown;
      if (std::isnan(out.height[i])) continue;
      const ColumnObstacles column = read_obstacles(map, p, x, y, out.height[i]);
      sums = column.sums;
      out.obstacle_density[i] = column.density();
      out.clearance[i] = column.clearance_m;
    }
}

void ObstacleFinder::find(const FusedView& map, const ColumnParameters& p, const GroundView& ground,
                          const LayerArrays& out) {
  const ColumnGrid& grid = ground.grid;
  read_columns(map, p, grid, out);
  for (std::int32_t y = 0, i = 0; y < grid.n_xy; ++y)
    for (std::int32_t x = 0; x < grid.n_xy; ++x, ++i) {
      const ObstacleSums* own = sums_.data() + grid.at(x, y);
      if (own->low_hits == 0) continue;
      ObstacleSums around{};
      for (std::int32_t dy = -1; dy <= 1; ++dy)
        for (std::int32_t dx = -1; dx <= 1; ++dx) around.add(own[dy * grid.pitch() + dx]);
      out.flags[i] |= obstacle_flags(map, grid, ground.lowest_ray_m, p, x, y, out.height[i], *own, around);
    }
}

}  // namespace gvom::cpu
