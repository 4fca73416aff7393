#include "core/cpu/obstacle_finder.hpp"

#include "core/cpu/clones.hpp"
#include "core/cpu/stacks.hpp"

namespace gvom::cpu {

namespace {

GVOM_CLONES void look_around(const std::uint8_t* low, std::int32_t pitch, std::int32_t n,
                             std::uint8_t* low_near) {
  GVOM_INDEPENDENT
  for (std::int32_t x = 0; x < n; ++x) {
    const std::uint8_t* row = low + x;
    const int before = row[-pitch - 1] | row[-pitch] | row[-pitch + 1];
    const int here = row[-1] | row[0] | row[1];
    const int after = row[pitch - 1] | row[pitch] | row[pitch + 1];
    low_near[x] = static_cast<std::uint8_t>(before | here | after);
  }
}

}  // namespace

ObstacleFinder::ObstacleFinder(std::int32_t n_xy) {
  const auto size = static_cast<std::size_t>(ColumnGrid{n_xy}.size());
  sums_.resize(size);
  lowest_.resize(size);
  low_.resize(size);
  low_near_.resize(static_cast<std::size_t>(n_xy));
}

void ObstacleFinder::read_columns(const FusedView& map, const WindowMaps& maps, const ColumnParameters& p,
                                  const ColumnGrid& grid, const LayerArrays& out) {
  for_each_by_stacks(grid.n_xy, [&](std::int32_t x, std::int32_t y) {
    const auto at = static_cast<std::size_t>(grid.at(x, y));
    const std::int32_t i = y * grid.n_xy + x;
    sums_[at] = {};
    low_[at] = 0;
    out.obstacle_density[i] = out.clearance[i] = kUnknown;
    if (std::isnan(out.height[i])) return;
    const ColumnObstacles column =
        read_obstacles(map, maps, p, x, y, out.height[i], is_remembered(out.visibility[i]));
    sums_[at] = column.sums;
    lowest_[at] = column.lowest;
    low_[at] = column.sums.low_hits > 0 ? 1 : 0;
    out.obstacle_density[i] = column.density();
    out.clearance[i] = column.clearance_m;
  });
}

void ObstacleFinder::find(const FusedView& map, const WindowMaps& maps, const ColumnParameters& p,
                          const GroundView& ground, const LayerArrays& out) {
  const ColumnGrid& grid = ground.grid;
  read_columns(map, maps, p, grid, out);
  for (std::int32_t y = 0, i = 0; y < grid.n_xy; ++y) {
    look_around(low_.data() + grid.at(0, y), grid.pitch(), grid.n_xy, low_near_.data());
    for (std::int32_t x = 0; x < grid.n_xy; ++x, ++i) {
      if (low_near_[static_cast<std::size_t>(x)] == 0 || std::isnan(out.height[i])) continue;
      const std::int32_t at = grid.at(x, y);
      const ObstacleSums* own = sums_.data() + at;
      ObstacleSums around{};
      for (std::int32_t dy = -1; dy <= 1; ++dy)
        for (std::int32_t dx = -1; dx <= 1; ++dx) around.add(own[dy * grid.pitch() + dx]);
      const ShadowRays rays{map, grid, ground.lowest_ray_m, is_remembered(out.visibility[i])};
      out.flags[i] |=
          obstacle_flags(rays, p, x, y, out.height[i], *own, around, lowest_[static_cast<std::size_t>(at)]);
    }
  }
}

}  // namespace gvom::cpu
