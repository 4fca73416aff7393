// The maps that a tick is about, and where they have a brick.
//
// The lanes of a warp look for a brick in 32 maps of the window at once: one after the other, each look would
// wait for the memory.
#pragma once

#include <cuda_runtime.h>

#include "core/cell.hpp"
#include "core/cuda/cell_column.hpp"
#include "core/cuda/device_map.hpp"
#include "core/cuda/lanes.hpp"
#include "core/memory.hpp"

namespace gvom::cuda {

/// What the memory must know of a tick (R17).
struct MemoryTick {
  std::int64_t now;           ///< The beat of the newest stamp.
  std::int32_t beats;         ///< How long something is remembered; 0: nothing is.
  std::int32_t spans_passed;  ///< Of rays: so many begin with this tick.
  bool all_too_old;           ///< What was remembered before it.

  /// Of a beat that is not newer than `now`, from a tick before.
  [[nodiscard]] __device__ bool is_too_old(std::uint8_t beat) const {
    return all_too_old || beats_between(beat, static_cast<std::uint8_t>(now)) > beats;
  }
};

/// What changes when a map comes. Behind it in memory lie the maps of the window, newest first, then those
/// that left.
struct FuseTick {
  Grid grid;    ///< Now: that of the newest map (R7).
  Grid before;  ///< Of size 0 if nothing was there.
  std::int32_t added;
  std::int32_t window_maps;
  std::int32_t left_maps;
  bool moved_in_z;
  MemoryTick memory;

  [[nodiscard]] __device__ const DeviceMap& map(std::int32_t i) const {
    return reinterpret_cast<const DeviceMap*>(this + 1)[i];
  }
  [[nodiscard]] __device__ const DeviceMap& left(std::int32_t i) const { return map(window_maps + i); }
  [[nodiscard]] __device__ bool enters(const Int3& world_brick) const {
    return before.slot_of_brick(world_brick) < 0;
  }
};
static_assert(sizeof(FuseTick) % alignof(DeviceMap) == 0);

/// The window's maps as `presence` reads them (R11).
struct WindowMaps {
  const FuseTick* tick;

  [[nodiscard]] __device__ std::int32_t count() const { return tick->window_maps; }
  [[nodiscard]] __device__ std::int64_t stamp_ns(std::int32_t i) const { return tick->map(i).stamp_ns; }
  [[nodiscard]] __device__ std::int32_t lookup(std::int32_t i, const Int3& world) const {
    return lookup_at(tick->map(i), world);
  }
};

/// A brick in 32 maps, a lane for each.
class Holders {
 public:
  /// Looks for it in `count` maps from `first` on, at most 32.
  __device__ Holders(const FuseTick& tick, std::int32_t first, std::int32_t count, const Int3& world_brick) {
    for_each_lane([&](std::int32_t lane) {
      if (lane >= count) return;
      const DeviceMap& map = tick.map(first + lane);
      const std::int32_t brick = map.brick_at(world_brick);
      if (brick >= 0) lookup_[lane] = map.lookup_of(brick);
      records_[lane] = map.records;
    });
    holders_ = vote([&](std::int32_t lane) { return lookup_[lane] != nullptr; });
  }

  [[nodiscard]] __device__ bool any() const { return holders_ != 0; }

  /// Calls `visit(MapBrick)` for those that have it.
  template <class Visit>
  __device__ void for_each(Visit&& visit) const {
    for (std::uint32_t left = holders_; left != 0; left &= left - 1) {
      const std::int32_t lane = lowest_lane(left);
      visit(MapBrick{of_lane(lookup_, lane), of_lane(records_, lane)});
    }
  }

  /// The lowest heights of a column's voxels in any of them, of those whose bit is set.
  [[nodiscard]] __device__ Eight<float> minima(std::int32_t column, std::uint32_t voxels) const {
    PerLane<Eight<float>> min_m;
    for_each_lane([&](std::int32_t lane) {
      Eight<std::int32_t> lookup;
      if (lookup_[lane] != nullptr) lookup = MapBrick{lookup_[lane], nullptr}.column(column);
      GVOM_UNROLL
      for (int z = 0; z < kBrickEdge; ++z) {
        const bool hit = lookup_[lane] != nullptr && (voxels >> z & 1) != 0 && lookup.at[z] >= 0;
        min_m[lane].at[z] = hit ? records_[lane][lookup.at[z]].min_height_m : kNoHeight_m;
      }
    });
    Eight<float> lowest_m;
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z) {
      lowest_m.at[z] = kNoHeight_m;
      if ((voxels >> z & 1) != 0)
        lowest_m.at[z] = lowest_of_lanes([&](std::int32_t lane) { return min_m[lane].at[z]; });
    }
    return lowest_m;
  }

 private:
  PerLane<const std::int32_t*> lookup_;
  PerLane<const VoxelRecord*> records_;
  std::uint32_t holders_;
};

/// Calls `visit(Holders)` for all `count` maps from `first` on, 32 at a time.
template <class Visit>
__device__ void for_each_holders(const FuseTick& tick, std::int32_t first, std::int32_t count,
                                 const Int3& world_brick, Visit&& visit) {
  for (std::int32_t begin = 0; begin < count; begin += kLanes) {
    const Holders holders(tick, first + begin, count - begin, world_brick);
    if (holders.any()) visit(holders);
  }
}

}  // namespace gvom::cuda
