// From the fused map to layers (R9..R16), column by column.
//
// Each kernel reads what those before it wrote of the columns around; none writes what another thread of it
// reads.
#pragma once

#include <cuda_runtime.h>

#include "core/column.hpp"
#include "core/column_grid.hpp"
#include "core/cuda/fuse_tick.hpp"
#include "core/ground.hpp"
#include "core/negative.hpp"
#include "core/obstacle.hpp"
#include "core/plane.hpp"

namespace gvom::cuda {

/// What the layers of one tick are made of and where they go; pointers of the device.
struct LayerTick {
  FusedView map;
  WindowMaps window;  ///< Of which `map` is the sum.
  ColumnParameters parameters;
  HoleParameters holes;
  LayerArrays out;
};

/// What kernels tell each other of the columns, in arrays of `ColumnGrid::size()` whose margin says that
/// nothing is known.
struct ColumnArrays {
  ColumnGrid grid;
  float* lowest_ray_m;  ///< As in GroundView, as are `ground_m` and `is_rim`.
  float* ground_m;
  float* lowest_m;         ///< Of the lowest return, or kNone_m.
  float* cone_m;           ///< The lowest cone over ground of the same row, or kNone_m.
  float* plane_m;          ///< `height` where there is ground, else kUnknown.
  std::uint8_t* standing;  ///< Of `Standing`.
  std::uint8_t* is_rim;
  std::int8_t* votes;        ///< On whether ground is doubtful: `rim_vote`.
  std::int8_t* row_votes;    ///< Their sum over the columns of the row.
  std::uint8_t* shows_hole;  ///< 1 or 0.
  ObstacleSums* obstacles;
  std::uint8_t* lowest_obstacle;  ///< The lowest obstacle voxel.

  /// Of the column `i` of a layer.
  [[nodiscard]] __device__ std::int32_t x(std::int32_t i) const { return i % grid.n_xy; }
  [[nodiscard]] __device__ std::int32_t y(std::int32_t i) const { return i / grid.n_xy; }
  [[nodiscard]] __device__ std::int32_t at(std::int32_t i) const { return grid.at(x(i), y(i)); }
  [[nodiscard]] __device__ GroundView ground() const { return {grid, lowest_ray_m, ground_m, is_rim}; }
};

/// For each column, [y][x]: what its own voxels say of the ground (R9, R10, R15).
struct ReadColumns {
  const LayerTick* tick;
  ColumnArrays columns;

  __device__ void operator()(std::int32_t i) const {
    const FusedView& map = tick->map;
    const LayerArrays& out = tick->out;
    const std::int32_t x = columns.x(i), y = columns.y(i), at = columns.at(i);
    const ColumnGround column = read_ground(map, tick->parameters, x, y);
    columns.lowest_ray_m[at] = column.lowest_ray_m;
    columns.ground_m[at] = column.ground_m;
    columns.lowest_m[at] = column.lowest_m;
    out.inferred_height[i] = column.inferred_height;
    out.last_seen[i] = column.last_seen;
    out.flags[i] = column.assumed ? kAssumed : 0;
    out.visibility[i] = static_cast<std::uint8_t>(visibility_of(column));
  }
};

/// How much higher ground may be than ground some columns off (R9): of one resolution, metres.
struct AllowedRises {
  float over_sides_m[kLines][kSides];  ///< From a distance of 1 on.
  float cone_m[kConeReach + 1];        ///< From a distance of 0 on.
};

/// For each column: the lowest cone over the ground of its row (R9).
struct SpreadCones {
  ColumnArrays columns;
  AllowedRises rises;

  __device__ void operator()(std::int32_t i) const {
    const float* ground_m = columns.ground_m + columns.at(i);
    float cone_m = *ground_m;
    GVOM_UNROLL
    for (std::int32_t d = 1; d <= kConeReach; ++d)
      cone_m = lower_of(cone_m, lower_of(ground_m[-d], ground_m[d]) + rises.cone_m[d]);
    columns.cone_m[columns.at(i)] = cone_m;
  }
};

/// For each column: whether its ground stands out or towers, and whether it may be a rim (R9).
struct FindRims {
  ColumnArrays columns;
  AllowedRises rises;

  __device__ void operator()(std::int32_t i) const {
    const std::int32_t at = columns.at(i);
    const float ground_m = columns.ground_m[at], cone_m = lowest_cone_m(columns.cone_m + at);
    const bool out = stands_out(columns.ground_m + at), rim = is_rim(ground_m, cone_m, out);
    columns.standing[at] =
        static_cast<std::uint8_t>((out ? kStandsOut : 0) | (towers(ground_m, cone_m) ? kDoubtful : 0));
    columns.is_rim[at] = rim ? 1 : 0;
    columns.votes[at] = rim_vote(ground_m, rim);
  }

 private:
  [[nodiscard]] __device__ bool stands_out(const float* ground_m) const {
    bool any = false;
    GVOM_UNROLL
    for (std::int32_t line = 0; line < kLines; ++line) {
      const std::int32_t step = line_offset(columns.grid, line);
      GVOM_UNROLL
      for (std::int32_t d = 1; d <= kSides; ++d)
        any |=
            rises_over(*ground_m, ground_m[d * step], ground_m[-d * step], rises.over_sides_m[line][d - 1]);
    }
    return any;
  }

  /// From those of the rows around.
  [[nodiscard]] __device__ float lowest_cone_m(const float* row_cone_m) const {
    const std::int32_t pitch = columns.grid.pitch();
    float cone_m = *row_cone_m;
    GVOM_UNROLL
    for (std::int32_t d = 1; d <= kConeReach; ++d)
      cone_m = lower_of(cone_m, lower_of(row_cone_m[d * pitch], row_cone_m[-d * pitch]) + rises.cone_m[d]);
    return cone_m;
  }
};

/// For each column: the votes of its row (R9).
struct CountVotes {
  ColumnArrays columns;

  __device__ void operator()(std::int32_t i) const {
    const std::int8_t* votes = columns.votes + columns.at(i);
    std::int32_t sum = *votes;
    GVOM_UNROLL
    for (std::int32_t d = 1; d <= kConeReach; ++d) sum += votes[-d] + votes[d];
    columns.row_votes[columns.at(i)] = static_cast<std::int8_t>(sum);
  }
};

/// For each column: whether the vote of those around is against its ground (R9).
struct DoubtGround {
  ColumnArrays columns;

  __device__ void operator()(std::int32_t i) const {
    const std::int32_t at = columns.at(i), pitch = columns.grid.pitch();
    if (columns.ground_m[at] == kNone_m) return;
    std::int32_t sum = columns.row_votes[at];
    GVOM_UNROLL
    for (std::int32_t d = 1; d <= kConeReach; ++d)
      sum += columns.row_votes[at - d * pitch] + columns.row_votes[at + d * pitch];
    if (sum >= 0) return;
    columns.standing[at] |= static_cast<std::uint8_t>(kDoubtful);
    columns.is_rim[at] = 0;
  }
};

/// For each column: its height (R9), and what stands and hangs over it (R11, R14).
struct WriteHeights {
  const LayerTick* tick;
  ColumnArrays columns;

  __device__ void operator()(std::int32_t i) const {
    const LayerArrays& out = tick->out;
    const std::int32_t at = columns.at(i);
    const float ground_m = columns.ground_m[at], lowest_m = columns.lowest_m[at];
    const bool hangs = ground_m == kNone_m && lowest_m != kNone_m;
    float height_m = ground_m;
    if (hangs || columns.standing[at] != 0)
      height_m = height_by_rims_m(columns.ground(), at, lowest_m, columns.standing[at],
                                  tick->parameters.resolution_xy_m);
    const bool known = height_m != kNone_m;
    out.height[i] = known ? height_m : kUnknown;
    columns.plane_m[at] = known && ground_m != kNone_m ? height_m : kUnknown;
    if (!known && lowest_m != kNone_m) out.visibility[i] = without_height(out.visibility[i]);
    ColumnObstacles over{};
    if (known)
      over = read_obstacles(tick->map, tick->window, tick->parameters, columns.x(i), columns.y(i), height_m,
                            is_remembered(out.visibility[i]));
    columns.obstacles[at] = over.sums;
    columns.lowest_obstacle[at] = over.lowest;
    out.obstacle_density[i] = known ? over.density() : kUnknown;
    out.clearance[i] = known ? over.clearance_m : kUnknown;
  }
};

/// For each column: obstacles by what the columns around have (R11), slope and roughness (R12), and how deep
/// a hole shows there (R13).
struct JudgeColumns {
  const LayerTick* tick;
  ColumnArrays columns;

  __device__ void operator()(std::int32_t i) const {
    const LayerArrays& out = tick->out;
    const std::int32_t x = columns.x(i), y = columns.y(i), at = columns.at(i);
    const Plane plane = fit(i);
    out.slope_x[i] = plane.slope_x;
    out.slope_y[i] = plane.slope_y;
    out.slope[i] = plane.slope;
    out.roughness[i] = plane.roughness;
    out.flags[i] |= static_cast<std::uint8_t>((plane.steep ? kSteep : 0) | obstacles(i));
    const float depth_m = hole_m(x, y);
    out.negative_delta[i] = depth_m;
    columns.shows_hole[at] = depth_m > 0 ? 1 : 0;
  }

 private:
  [[nodiscard]] __device__ float hole_m(std::int32_t x, std::int32_t y) const {
    const std::int32_t at = columns.grid.at(x, y);
    const GroundView ground = columns.ground();
    if (may_hide_hole(ground, at)) {
      const HoleParameters& p = tick->holes;
      const SightLine line(columns.grid, x, y, p.vehicle_x, p.vehicle_y);
      const Abreast steps{ground, line.beside()};
      return static_cast<float>(HoleSearch(ground, steps, p, line, columns.lowest_ray_m[at]).depth_m());
    }
    float deepest_m = 0;
    for (std::int32_t line = 0; line < kLines; ++line)
      for (std::int32_t d = 1; d <= kPitSides; ++d) {
        const std::int32_t off = d * line_offset(columns.grid, line);
        const float pit_m = pit_depth_m(columns.ground_m[at], rim_m(at - off), rim_m(at + off),
                                        tick->holes.pits.least_m[line][d - 1]);
        deepest_m = pit_m > deepest_m ? pit_m : deepest_m;
      }
    return deepest_m;
  }
  [[nodiscard]] __device__ float rim_m(std::int32_t at) const {
    return rim_height_m(columns.ground_m[at], columns.is_rim[at] != 0);
  }

  [[nodiscard]] __device__ std::uint8_t obstacles(std::int32_t i) const {
    if (std::isnan(tick->out.height[i])) return 0;
    const ColumnGrid& grid = columns.grid;
    const std::int32_t x = columns.x(i), y = columns.y(i), at = grid.at(x, y);
    const ObstacleSums* own = columns.obstacles + at;
    ObstacleSums around{};
    for (std::int32_t dy = -1; dy <= 1; ++dy)
      for (std::int32_t dx = -1; dx <= 1; ++dx) around.add(own[dy * grid.pitch() + dx]);
    const ShadowRays rays{tick->map, grid, columns.lowest_ray_m, is_remembered(tick->out.visibility[i])};
    return obstacle_flags(rays, tick->parameters, x, y, tick->out.height[i], *own, around,
                          columns.lowest_obstacle[at]);
  }

  [[nodiscard]] __device__ Plane fit(std::int32_t i) const {
    const ColumnParameters& p = tick->parameters;
    const float* middle_m = columns.plane_m + columns.at(i);
    const std::int32_t radius = p.layers.plane_size / 2, pitch = columns.grid.pitch();
    PlaneSums sums{};
    for (std::int32_t dy = -radius; dy <= radius; ++dy)
      for (std::int32_t dx = -radius; dx <= radius; ++dx) add_height(sums, dx, dy, middle_m[dy * pitch + dx]);
    const PlaneFit fit = solve_plane(sums);
    double squares_m2 = 0;
    for (std::int32_t dy = -radius; dy <= radius; ++dy)
      for (std::int32_t dx = -radius; dx <= radius; ++dx)
        squares_m2 += squared_residual(fit, dx, dy, middle_m[dy * pitch + dx]);
    const auto source = [&](std::int32_t dx, std::int32_t dy) {
      if (std::isnan(middle_m[dy * pitch + dx])) return kNoGround;
      return source_of_ground(tick->out.visibility[i + dy * columns.grid.n_xy + dx]);
    };
    return plane_layers(fit, sums, squares_m2, p.resolution_xy_m, p.layers.slope_threshold_rad,
                        [&] { return is_seam(radius, source); });
  }
};

/// For each column: NEGATIVE by its neighbours (R13), and the cost (R16).
struct FinishColumns {
  const LayerTick* tick;
  ColumnArrays columns;

  __device__ void operator()(std::int32_t i) const {
    const LayerArrays& out = tick->out;
    std::uint8_t flags = out.flags[i];
    if (is_negative(columns.grid, columns.shows_hole, tick->holes, columns.x(i), columns.y(i)))
      flags |= kNegative;
    out.flags[i] = flags;
    out.cost[i] = column_cost(tick->parameters.cost, flags, out.height[i], out.obstacle_density[i],
                              out.slope[i], out.roughness[i]);
  }
};

}  // namespace gvom::cuda
