// From the fused map to layers (R9..R16), column by column.
#pragma once

#include "core/column.hpp"
#include "core/cuda/lanes.hpp"
#include "core/negative.hpp"
#include "core/plane.hpp"

namespace gvom::cuda {

/// What the layers of one tick are made of and where they go; pointers of the device.
struct LayerTick {
  FusedView map;
  ColumnParameters parameters;
  LayerArrays out;
};

/// For each column, [y][x]: what does not depend on its neighbours (R9, R10, R11, R14, R15).
struct ReadColumns {
  const LayerTick* tick;

  __device__ void operator()(std::int32_t i) const {
    const FusedView& map = tick->map;
    write_column(read_column(map, tick->parameters, i % map.n_xy, i / map.n_xy), tick->out, i);
  }
};

/// Which columns of each line have a height, a bit for each: lines along x, [y][word], and along y,
/// [x][word].
struct DefinedHeights {
  std::uint64_t* along_x;
  std::uint64_t* along_y;
  std::int32_t words;  ///< Of a line.
};

/// For each half of a word of each line, along x, then along y: its bits, a lane for each.
struct MarkDefined {
  const LayerTick* tick;
  DefinedHeights defined;

  __device__ void operator()(std::int32_t i) const {
    const std::int32_t n = tick->map.n_xy, halves = 2 * defined.words;
    const bool along_y = i >= n * halves;
    const std::int32_t line = i % n,
                       half = i / n % halves;  // neighbouring warps share what they read along y
    const std::uint32_t bits = vote([&](std::int32_t lane) {
      const std::int32_t at = half * kLanes + lane;
      if (at >= n) return false;
      const float height_m = tick->out.height[along_y ? at * n + line : line * n + at];
      return height_m == height_m;
    });
    // Little-endian, as all machines with CUDA are.
    auto* const out = reinterpret_cast<std::uint32_t*>(along_y ? defined.along_y : defined.along_x);
    in_lane(0, [&] { out[line * halves + half] = bits; });
  }
};

/// The offset of the set bit that is nearest to bit `at` of a line, the smaller one on a tie; kNoneInRow if
/// none is set.
__device__ inline std::int16_t nearest_set_bit(const std::uint64_t* line, std::int32_t words,
                                               std::int32_t at) {
  const std::int32_t before = last_bit_up_to(line, at);
  const std::int32_t after = next_bit(line, words, at);
  if (before < 0 && after < 0) return kNoneInRow;
  if (before < 0) return static_cast<std::int16_t>(after - at);
  if (after < 0 || at - before <= after - at) return static_cast<std::int16_t>(before - at);
  return static_cast<std::int16_t>(after - at);
}

/// For each column: the nearest heights in its two lines (R13).
struct FindNearest {
  DefinedHeights defined;
  std::int16_t* along_x;  ///< As in NearestHeights.
  std::int16_t* along_y;
  std::int32_t n_xy;

  __device__ void operator()(std::int32_t i) const {
    const std::int32_t x = i % n_xy, y = i / n_xy, words = defined.words;
    along_x[i] = nearest_set_bit(defined.along_x + y * words, words, x);
    along_y[i] = nearest_set_bit(defined.along_y + x * words, words, y);
  }
};

/// For each column: what depends on its neighbours (R12, R13), and the cost (R16).
struct FinishColumns {
  const LayerTick* tick;
  NearestHeights nearest;

  __device__ void operator()(std::int32_t i) const {
    const LayerArrays& out = tick->out;
    const ColumnParameters& p = tick->parameters;
    const Plane plane = fit(i);
    const double delta_m = negative(i);
    std::uint8_t flags = out.flags[i];
    if (plane.steep) flags |= kSteep;
    if (delta_m > p.layers.negative_threshold_m) flags |= kNegative;
    out.slope_x[i] = plane.slope_x;
    out.slope_y[i] = plane.slope_y;
    out.slope[i] = plane.slope;
    out.roughness[i] = plane.roughness;
    out.negative_delta[i] = static_cast<float>(delta_m);
    out.flags[i] = flags;
    out.cost[i] =
        column_cost(p.cost, flags, out.height[i], out.obstacle_density[i], plane.slope, plane.roughness);
  }

 private:
  /// The height of a column; unknown beyond the grid.
  __device__ float height(std::int32_t x, std::int32_t y) const {
    const std::int32_t n = tick->map.n_xy;
    return x < 0 || y < 0 || x >= n || y >= n ? kUnknown : tick->out.height[y * n + x];
  }

  __device__ Plane fit(std::int32_t i) const {
    const std::int32_t x = i % tick->map.n_xy, y = i / tick->map.n_xy;
    const std::int32_t radius = tick->parameters.layers.plane_size / 2;
    PlaneSums sums{};
    for (std::int32_t dy = -radius; dy <= radius; ++dy)
      for (std::int32_t dx = -radius; dx <= radius; ++dx) add_height(sums, dx, dy, height(x + dx, y + dy));
    const PlaneFit fit = solve_plane(sums);
    double squares_m2 = 0;
    for (std::int32_t dy = -radius; dy <= radius; ++dy)
      for (std::int32_t dx = -radius; dx <= radius; ++dx)
        squares_m2 += squared_residual(fit, dx, dy, height(x + dx, y + dy));
    return plane_layers(fit, sums.n, squares_m2, tick->parameters.resolution_xy_m,
                        tick->parameters.layers.slope_threshold_rad);
  }

  __device__ double negative(std::int32_t i) const {
    const std::int32_t n = tick->map.n_xy;
    const LayerArrays& out = tick->out;
    if (!seen_through(out.height[i], out.inferred_height[i])) return 0;
    std::int32_t found[kDirections];
    for (int direction = 0; direction < kDirections; ++direction)
      found[direction] =
          search_cone(nearest, n, i % n, i / n, direction, tick->parameters.layers.search_distance);
    return negative_delta(out.height, nearest, n, i, found, out.inferred_height[i]);
  }
};

}  // namespace gvom::cuda
