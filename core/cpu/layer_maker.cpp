#include "core/cpu/layer_maker.hpp"

#include <algorithm>
#include <cmath>

#include "core/cpu/clones.hpp"

namespace gvom::cpu {

namespace {

constexpr std::int32_t kFar = kNoneInRow;

// Of the offsets to the nearest defined height before (<= 0) and after (>= 0): the nearer, on a tie the
// one before.
std::int16_t nearer(std::int32_t before, std::int32_t after) {
  return static_cast<std::int16_t>(-before <= after ? before : after);
}

// Fills `nearest` along one row (stride 1) or one column (stride n) of the height layer.
void nearest_in_line(const float* height, std::ptrdiff_t stride, std::int32_t n, std::int16_t* nearest) {
  std::int32_t before = -kFar;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    before = std::isnan(height[i * stride]) ? std::max(before - 1, -kFar) : 0;
    nearest[i * stride] = static_cast<std::int16_t>(before);
  }
  std::int32_t after = kFar;
  for (std::ptrdiff_t i = n - 1; i >= 0; --i) {
    after = std::isnan(height[i * stride]) ? std::min(after + 1, kFar) : 0;
    nearest[i * stride] = nearer(nearest[i * stride], after);
  }
}

void read_columns(const FusedView& map, const ColumnParameters& p, const LayerArrays& out) {
  for (std::int32_t y = 0, i = 0; y < map.n_xy; ++y)
    for (std::int32_t x = 0; x < map.n_xy; ++x, ++i) {
      const Column column = read_column(map, p, x, y);
      out.height[i] = column.height;
      out.inferred_height[i] = column.inferred_height;
      out.obstacle_density[i] = column.obstacle_density;
      out.clearance[i] = column.clearance;
      out.last_seen[i] = column.last_seen;
      out.flags[i] = column.flags;
      out.visibility[i] = column.visibility;
    }
}

void find_negative(std::int32_t n_xy, const ColumnParameters& p, const NearestHeights& nearest,
                   const LayerArrays& out) {
  for (std::int32_t y = 0, i = 0; y < n_xy; ++y)
    for (std::int32_t x = 0; x < n_xy; ++x, ++i) {
      out.negative_delta[i] = 0;
      if (!seen_through(out.height[i], out.inferred_height[i])) continue;
      const double delta_m =
          negative_delta(out.height, nearest, n_xy, x, y, out.inferred_height[i], p.layers.search_distance);
      out.negative_delta[i] = static_cast<float>(delta_m);
      if (delta_m > p.layers.negative_threshold_m) out.flags[i] |= kNegative;
    }
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
      along_x_(static_cast<std::size_t>(n_xy_) * static_cast<std::size_t>(n_xy_)),
      along_y_(along_x_.size()),
      planes_(n_xy_, config.layers.plane_size) {}

void LayerMaker::find_nearest_heights(const float* height) {
  for (std::ptrdiff_t line = 0; line < n_xy_; ++line) {
    nearest_in_line(height + line * n_xy_, 1, n_xy_, along_x_.data() + line * n_xy_);
    nearest_in_line(height + line, n_xy_, n_xy_, along_y_.data() + line);
  }
}

void LayerMaker::make(const FusedView& map, const LayerMoment& moment, const LayerArrays& out) {
  const ColumnParameters p = column_parameters(config_, moment);
  read_columns(map, p, out);
  planes_.fit(p, out);
  find_nearest_heights(out.height);
  find_negative(n_xy_, p, {along_x_.data(), along_y_.data()}, out);
  add_up_cost(n_xy_ * n_xy_, p, out);
}

}  // namespace gvom::cpu
