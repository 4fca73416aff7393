// Voxels of a grid in bricks, with the paper's pair of lookup and data (R6). Views only: the memory is
// the caller's, usually a chunk of shared memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/grid.hpp"
#include "core/pose.hpp"

namespace gvom {

/// Data of an occupied voxel (R6).
struct VoxelRecord {
  std::uint32_t hits;
  std::uint32_t passes;
  float min_height_m;
};

/// Lookup value of a voxel that is not occupied, and back: -1 - passes (R6), which is the complement.
GVOM_HD inline std::int32_t free_lookup(std::uint32_t passes) {
  return static_cast<std::int32_t>(~passes);
}
GVOM_HD inline std::uint32_t passes_of(std::int32_t lookup) {
  return ~static_cast<std::uint32_t>(lookup);
}

/// How much room a map's arrays take.
struct BrickMapShape {
  std::uint32_t brick_slots = 0;   ///< Bricks of the whole grid.
  std::uint32_t brick_count = 0;   ///< Bricks with an observed voxel.
  std::uint32_t record_count = 0;  ///< Voxels with hits.
};

/// The arrays of a map to be written.
struct BrickMapArrays {
  std::int32_t* directory;  ///< [brick_slots], slot = (bz * ny + by) * nx + bx: brick or -1.
  std::int32_t* lookup;     ///< [brick_count * 512], cell = (x * 8 + y) * 8 + z: record, or -1 - passes.
  std::uint64_t* columns;   ///< [brick_count], bit x * 8 + y: the brick's column has an observed voxel.
  VoxelRecord* records;     ///< [record_count], in the order of bricks and cells.
};

/// A map to be read.
struct BrickMapView {
  Grid grid;
  std::int64_t stamp_ns = 0;
  Pose T_odom_base;  ///< At the stamp.
  BrickMapShape shape;
  const std::int32_t* directory = nullptr;
  const std::int32_t* lookup = nullptr;
  const std::uint64_t* columns = nullptr;
  const VoxelRecord* records = nullptr;

  /// The brick at world brick coordinates, or -1 where the grid or its touched part does not reach.
  [[nodiscard]] std::int32_t brick_at(const Int3& world_brick) const {
    const Int3 n = grid.bricks();
    Int3 b;
    for (int a = 0; a < 3; ++a) {
      b[a] = world_brick[a] - grid.origin[a] / kBrickEdge;
      if (b[a] < 0 || b[a] >= n[a]) return -1;
    }
    return directory[brick_slot(b[0], b[1], b[2], n[0], n[1])];
  }
};

}  // namespace gvom
