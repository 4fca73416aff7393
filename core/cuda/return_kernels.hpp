// From returns to counted voxels and columns (R2..R5a), return by return.
#pragma once

#include "core/cell.hpp"
#include "core/cuda/atomics.hpp"
#include "core/cuda/device_map.hpp"
#include "core/lowest_ray.hpp"
#include "core/returns.hpp"

namespace gvom::cuda {

/// The sensor at one time of a sweep (R3), and where its rays start (core/ray.hpp).
struct SensorPose {
  RigidTransform T_odom_sensor;
  std::int64_t from[3];
};

/// The counters of a sweep; pointers of the device. Bricks are those of the grid from its origin.
struct SweepCounters {
  Grid grid;
  DenseBricks bricks;
  std::uint8_t* touched;    ///< Per brick: something was counted in it.
  std::uint32_t* verdicts;  ///< By Verdict.
  std::int32_t* lowest;     ///< Per column (`column_in_stacks`): core/lowest_ray.hpp.
};

/// For each return: filters it, counts the passes of its ray and its hit.
struct CastReturn {
  SweepCounters counters;
  ReturnFilter filter;
  const Return* returns;
  const SensorPose* poses;  ///< By Return::time_index.

  __device__ void operator()(std::int32_t i) const {
    const Return r = returns[i];
    const Verdict verdict = filter.judge(r);
    add_one(counters.verdicts + static_cast<std::uint32_t>(verdict));
    if (verdict != Verdict::used) return;
    const SensorPose& sensor = poses[r.time_index];
    double p_m[3];
    std::int64_t to[3];
    GVOM_UNROLL
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      p_m[a] = sensor.T_odom_sensor.coordinate(a, r.x_m, r.y_m, r.z_m);
      to[a] = fixed_in_grid(p_m[a], counters.grid.resolution_m[axis], counters.grid.origin[axis]);
    }
    count_passes(sensor.from, to);
    const std::int32_t x = fixed_voxel(to[0]), y = fixed_voxel(to[1]), z = fixed_voxel(to[2]);
    if (!inside(x, y, z)) return;
    const std::size_t cell = touch(x, y, z);
    add_one(counters.bricks.hits + cell);
    lower_to(counters.bricks.min_height_m + cell, height_of_return(p_m[2]));
  }

 private:
  /// Up to the ray's end, or to where it leaves the grid for good.
  __device__ void count_passes(const std::int64_t (&from)[3], const std::int64_t (&to)[3]) const {
    bool entered = false;
    RayHeights heights(from, to);
    walk_ray(
        from, to,
        [this, &entered](std::int32_t x, std::int32_t y, std::int32_t z) {
          if (!inside(x, y, z)) return !entered;
          entered = true;
          add_one(counters.bricks.passes + touch(x, y, z));
          return true;
        },
        [this, &heights](int axis, std::int32_t x, std::int32_t y, std::int32_t z) {
          if (axis == 2) return;
          const ColumnLeft left = heights.leave(axis, x, y);
          if (inside(x, y, z) && inside(left.x, left.y, z))
            lower_to(counters.lowest + column_in_stacks(left.x, left.y, counters.bricks.bricks[0]),
                     left.height);
        });
  }

  __device__ bool inside(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const Int3& n = counters.grid.size;
    return x >= 0 && x < n[0] && y >= 0 && y < n[1] && z >= 0 && z < n[2];
  }

  /// Index of a voxel's counters; its brick counts from now on. All who touch a brick write the same.
  __device__ std::size_t touch(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const Int3& n = counters.bricks.bricks;
    const std::uint32_t brick = brick_slot(x >> 3, y >> 3, z >> 3, n[0], n[1]);
    mark(counters.touched + brick);
    return std::size_t{brick} * kBrickCells + cell_in_brick(x, y, z);
  }
};

/// For each column of each slot: empties it if it was touched.
struct ClearTouched {
  DenseBricks bricks;
  const std::uint8_t* touched;

  __device__ void operator()(std::int32_t i) const {
    if (touched[i / 64] == 0) return;
    const std::size_t begin = static_cast<std::size_t>(i) * kBrickEdge;
    Eight<std::uint32_t> none;
    Eight<float> no_height_m;
    for (int z = 0; z < kBrickEdge; ++z) none.at[z] = 0, no_height_m.at[z] = kNoHeight_m;
    write_eight(bricks.hits + begin, none);
    write_eight(bricks.passes + begin, none);
    write_eight(bricks.min_height_m + begin, no_height_m);
  }
};

}  // namespace gvom::cuda
