// How low rays have been in each column (R5a): of a sweep, and over the window.
#pragma once

#include "core/cuda/fuse_tick.hpp"
#include "core/lowest_ray.hpp"

namespace gvom::cuda {

/// For each column of a sweep: its height in metres.
struct MeasureRays {
  const std::int32_t* lowest;  ///< core/lowest_ray.hpp
  std::int32_t origin_z;
  double resolution_z_m;
  float* lowest_ray_m;

  __device__ void operator()(std::int32_t column) const {
    lowest_ray_m[column] = height_of_ray_m(lowest[column], origin_z, resolution_z_m);
  }
};

/// Where the columns of a stack of bricks begin in FusedView::lowest_ray_m.
__device__ inline std::size_t first_of_stack(const Int3& world_brick, std::int32_t bricks_xy) {
  return std::size_t{brick_slot(wrap(world_brick[0], bricks_xy), wrap(world_brick[1], bricks_xy), 0,
                                bricks_xy, bricks_xy)} *
         kBrickColumns;
}

/// For each column of the grid, in the order of a map: what the fused map has.
struct CopyRays {
  Grid grid;
  const float* fused_m;  ///< As in FusedView.
  float* lowest_ray_m;

  __device__ void operator()(std::int32_t column) const {
    const Int3 brick = world_brick(grid, column / kBrickColumns);
    const std::size_t first = first_of_stack(brick, grid.bricks()[0]);
    lowest_ray_m[column] = fused_m[first + static_cast<std::size_t>(column % kBrickColumns)];
  }
};

/// For each stack of the grid's bricks: the lowest rays of its 64 columns, two of them for a lane.
struct UpdateLowestRays {
  const FuseTick* tick;
  float* fused_m;  ///< As in FusedView.

  __device__ void operator()(std::int32_t stack) const {
    const Int3 brick = world_brick(tick->grid, stack);
    float* const stack_m = fused_m + first_of_stack(brick, tick->grid.bricks()[0]);
    PerLane<Pair> lowest;
    bool stale = tick->enters(brick);
    if (!stale) {
      for_each_lane([&](std::int32_t lane) { lowest[lane].lower(stack_m + lane); });
      lower_to(tick->added, 1, brick, lowest);
      stale = was_lowest(brick, lowest);
    }
    if (stale) {
      for_each_lane([&](std::int32_t lane) { lowest[lane] = Pair{}; });
      lower_to(0, tick->window_maps, brick, lowest);
    }
    for_each_lane([&](std::int32_t lane) {
      GVOM_UNROLL
      for (std::int32_t half = 0; half < Pair::kHalves; ++half)
        stack_m[lane + half * kLanes] = lowest[lane].at_m[half];
    });
  }

 private:
  /// Heights in the columns `lane` and `lane + 32`.
  struct Pair {
    static constexpr std::int32_t kHalves = kBrickColumns / kLanes;
    float at_m[kHalves] = {kNoRay_m, kNoRay_m};

    __device__ void lower(const float* from_m) {
      GVOM_UNROLL
      for (std::int32_t half = 0; half < kHalves; ++half)
        at_m[half] = gvom::lower(at_m[half], from_m[half * kLanes]);
    }
    /// Whether one of these is it.
    [[nodiscard]] __device__ bool is_one_of(const float* from_m) const {
      bool any = false;
      GVOM_UNROLL
      for (std::int32_t half = 0; half < kHalves; ++half)
        any |= at_m[half] == from_m[half * kLanes] && at_m[half] < kNoRay_m;
      return any;
    }
  };

  /// Calls `visit(heights of the stack)` for those of the maps that reach there. The lanes look for it in 32
  /// maps at once.
  template <class Visit>
  __device__ void for_each_map(std::int32_t first, std::int32_t count, const Int3& brick,
                               Visit&& visit) const {
    for (std::int32_t begin = 0; begin < count; begin += kLanes) {
      PerLane<const float*> of_map_m;
      for_each_lane([&](std::int32_t lane) {
        if (begin + lane < count)
          of_map_m[lane] = tick->map(first + begin + lane).lowest_rays_of(brick[0], brick[1]);
      });
      std::uint32_t reach = vote([&](std::int32_t lane) { return of_map_m[lane] != nullptr; });
      for (; reach != 0; reach &= reach - 1) visit(of_lane(of_map_m, lowest_lane(reach)));
    }
  }

  __device__ void lower_to(std::int32_t first, std::int32_t count, const Int3& brick,
                           PerLane<Pair>& lowest) const {
    for_each_map(first, count, brick, [&](const float* map_m) {
      for_each_lane([&](std::int32_t lane) { lowest[lane].lower(map_m + lane); });
    });
  }

  /// Whether one of the maps that left had a lowest ray: it is to be looked up in the window.
  __device__ bool was_lowest(const Int3& brick, const PerLane<Pair>& lowest) const {
    bool any = false;
    for_each_map(tick->window_maps, tick->left_maps, brick, [&](const float* map_m) {
      any |= vote([&](std::int32_t lane) { return lowest[lane].is_one_of(map_m + lane); }) != 0;
    });
    return any;
  }
};

}  // namespace gvom::cuda
