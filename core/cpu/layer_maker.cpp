#include "core/cpu/layer_maker.hpp"

#include <algorithm>
#include <cmath>

#include "core/cpu/clones.hpp"

namespace gvom::cpu {

namespace {

void read_columns(const FusedView& map, const ColumnParameters& p, const LayerArrays& out) {
  for (std::int32_t y = 0, i = 0; y < map.n_xy; ++y)
    for (std::int32_t x = 0; x < map.n_xy; ++x, ++i) write_column(read_column(map, p, x, y), out, i);
}

GVOM_CLONES void add_up_cost(std::int32_t columns, const ColumnParameters& p, const LayerArrays& out) {
  for (std::int32_t i = 0; i < columns; ++i)
    out.cost[i] = column_cost(p.cost, out.flags[i], out.height[i], out.obstacle_density[i], out.slope[i],
                              out.roughness[i]);
}

}  // namespace

LayerMaker::LayerMaker(const MapperConfig& config)
    : config_(config),
      n_xy_(config.map.size_xy),
      planes_(n_xy_, config.layers.plane_size),
      negatives_(n_xy_) {}

void LayerMaker::make(const FusedView& map, const LayerMoment& moment, const LayerArrays& out) {
  const ColumnParameters p = column_parameters(config_, moment);
  read_columns(map, p, out);
  planes_.fit(p, out);
  negatives_.find(p, out);
  add_up_cost(n_xy_ * n_xy_, p, out);
}

}  // namespace gvom::cpu
