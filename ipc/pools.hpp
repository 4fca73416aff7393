// How much shared memory a vehicle needs: pure arithmetic, the same in the broker, which makes the pools, and
// in the publishers, which ask for chunks of exactly these sizes (so every topic has a pool that nobody else
// drains).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ipc/error.hpp"

namespace gvom::ipc {

/// What of a vehicle's configuration decides the pools. Each field names its key.
struct PoolSpec {
  int size_xy = 256;         ///< `map.size_xy`, voxels, a multiple of 8.
  int size_z = 64;           ///< `map.size_z`, voxels, a multiple of 8.
  int lidars = 1;            ///< Entries of `lidars`, at most kMaxLidars.
  int buffer_size = 8;       ///< `window.buffer_size`, maps that fusion holds of each lidar.
  int max_returns = 262144;  ///< The largest of `lidars.*.max_returns`.
  int max_planners = 4;      ///< `ipc.max_planners`, readers of Layers and of VoxelMap.
  bool voxel_map = true;     ///< False if `fusion.voxel_rate_hz` is 0: no chunks for it.
};

struct Pool {
  std::uint32_t chunk_bytes;  ///< Payload, a multiple of 8.
  std::uint32_t chunks;
};

struct PoolPlan {
  std::vector<Pool> pools;    ///< Strictly increasing in size; each under 4 GiB.
  std::uint64_t total_bytes;  ///< Payload of all of them.
};

/// The bricks of the grid: brick_slots of its maps.
std::uint32_t brick_slots(const PoolSpec& spec);
/// The columns of the grid: column_count of its maps.
std::uint32_t columns(const PoolSpec& spec);

/// Bytes of the largest map that can be: every brick touched, every return (or voxel) a record of its own.
/// These are the capacities that BrickMapPublisher is opened with.
std::size_t buffer_map_capacity(const PoolSpec& spec);
std::size_t voxel_map_capacity(const PoolSpec& spec);

/// The pools for all topics. too_large if a pool would reach 4 GiB (chunks would overlap silently there); the
/// message names the topic and the keys to lower.
Expected<PoolPlan> plan_pools(const PoolSpec& spec);

}  // namespace gvom::ipc
