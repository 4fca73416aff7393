// What is remembered of maps that left the window (R17), in the device's memory.
#pragma once

#include <cuda_runtime.h>

#include "core/cuda/device_map.hpp"
#include "core/cuda/fuse_tick.hpp"
#include "core/memory.hpp"

namespace gvom::cuda {

/// Null pointers where nothing is remembered.
struct DeviceMemory {
  RememberedHits* hits;        ///< As the voxels of DenseBricks.
  RememberedPasses* passes;    ///< Likewise.
  std::uint16_t* oldest;       ///< For each half of a brick: no voxel is of an older beat; see `kept`.
  std::uint64_t* remembered;   ///< The mask of MemoryView.
  std::uint8_t* column_beats;  ///< Of MemoryView.
  float* lowest_ray_m;         ///< Likewise: the minimum of the spans.
  float* spans_m;              ///< `kSpans` times as many.

  static constexpr std::int32_t kHalves = 2;

  /// Whether something in the brick may be too old.
  [[nodiscard]] __device__ bool is_due(const MemoryTick& tick, const Int3& bricks,
                                       const Int3& world_brick) const {
    if (oldest == nullptr) return false;
    const std::uint16_t* halves = oldest + half_of(bricks, world_brick);
    bool due = false;
    for (std::int32_t half = 0; half < kHalves; ++half)
      due |= halves[half] != 0 && tick.is_too_old(static_cast<std::uint8_t>(halves[half]));
    return due;
  }
  /// Of the first half of a brick.
  [[nodiscard]] __device__ static std::size_t half_of(const Int3& bricks, const Int3& world_brick) {
    return std::size_t{brick_slot(wrap(world_brick[0], bricks[0]), wrap(world_brick[1], bricks[1]),
                                  wrap(world_brick[2], bricks[2]), bricks[0], bricks[1])} *
           kHalves;
  }
  /// `age` of the oldest beat in a half, -1 if it has none, as it is kept.
  [[nodiscard]] __device__ static std::uint16_t kept(std::int32_t age, std::int64_t now) {
    return age < 0 ? std::uint16_t{0} : static_cast<std::uint16_t>(0x100 | ((now - age) & 0xFF));
  }
};

}  // namespace gvom::cuda
