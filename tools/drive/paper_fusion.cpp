#include "tools/drive/paper_fusion.hpp"

namespace gvom::driving {

PaperFusion::PaperFusion(const MapperConfig& config, PaperRule rule)
    : config_(config),
      rule_(rule),
      map_(config),
      ground_(config.map.size_xy, config.map.resolution_xy_m),
      obstacles_(config.map.size_xy),
      planes_(config.map.size_xy, config.layers.plane_size),
      negatives_(config.map.size_xy),
      paper_ground_(config.map.size_xy),
      paper_holes_(config.map.size_xy) {}

/// As cpu::LayerMaker does, but for the rule.
DeviceExpected<void> PaperFusion::make_layers(const LayerArrays& out) {
  const FusedView map = map_.view();
  const ColumnParameters p = column_parameters(config_, newest_moment(window()));
  ground_.find(map, p, out);
  GroundView ground = ground_.view();
  if (rule_ == PaperRule::r9) ground = paper_ground_.find(map, p, ground, out);
  obstacles_.find(map, cpu::WindowMaps(window()), p, ground, out);
  planes_.fit(p, ground, out);
  if (rule_ == PaperRule::r13)
    paper_holes_.find(p.layers, out);
  else
    negatives_.find(p, ground, out);
  for (std::int32_t i = 0; i < config_.map.size_xy * config_.map.size_xy; ++i)
    out.cost[i] = column_cost(p.cost, out.flags[i], out.height[i], out.obstacle_density[i], out.slope[i],
                              out.roughness[i]);
  return {};
}

}  // namespace gvom::driving
