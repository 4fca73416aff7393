#include "core/cpu/layer_maker.hpp"

#include <algorithm>
#include <cmath>

#include "core/cpu/clones.hpp"

namespace gvom::cpu {

namespace {

GVOM_CLONES void add_up_cost(std::int32_t columns, const ColumnParameters& p, const LayerArrays& out) {
  for (std::int32_t i = 0; i < columns; ++i)
    out.cost[i] = column_cost(p.cost, out.flags[i], out.height[i], out.obstacle_density[i], out.slope[i],
                              out.roughness[i]);
}

}  // namespace

LayerMaker::LayerMaker(const MapperConfig& config)
    : config_(config),
      n_xy_(config.map.size_xy),
      ground_(n_xy_, config.map.resolution_xy_m),
      obstacles_(n_xy_),
      planes_(n_xy_, config.layers.plane_size),
      negatives_(n_xy_) {}

void LayerMaker::make(const FusedView& map, const Window& window, const LayerArrays& out) {
  const ColumnParameters p = column_parameters(config_, newest_moment(window));
  ground_.find(map, p, out);
  obstacles_.find(map, WindowMaps(window), p, ground_.view(), out);
  planes_.fit(p, ground_.view(), out);
  negatives_.find(p, ground_.view(), out);
  add_up_cost(n_xy_ * n_xy_, p, out);
}

}  // namespace gvom::cpu
