// Voxels of a grid in bricks, with the paper's pair of lookup and data (R6). Views only: the memory is
// the caller's, usually a chunk of shared memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/format/grid.hpp"

namespace gvom {

/// Data of an occupied voxel (R6).
struct VoxelRecord {
  std::uint32_t hits;
  std::uint32_t passes;
  float min_height_m;
};
static_assert(sizeof(VoxelRecord) == 12);

/// Lookup value of a voxel that is not occupied, and back: -1 - passes (R6), which is the complement.
GVOM_HD inline std::int32_t free_lookup(std::uint32_t passes) {
  return static_cast<std::int32_t>(~passes);
}
GVOM_HD inline std::uint32_t passes_of(std::int32_t lookup) {
  return ~static_cast<std::uint32_t>(lookup);
}

/// How many elements a map's arrays have.
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

/// Where the arrays lie in one piece of memory, bytes from its start; each is aligned to 64.
struct BrickMapLayout {
  std::size_t directory;
  std::size_t lookup;
  std::size_t columns;
  std::size_t records;
  std::size_t bytes;  ///< Of the whole piece.
};

inline constexpr std::size_t kArrayAlignment = 64;

constexpr std::size_t align_array(std::size_t offset) {
  return (offset + kArrayAlignment - 1) / kArrayAlignment * kArrayAlignment;
}

/// The layout behind a header of `header_bytes`.
constexpr BrickMapLayout brick_map_layout(std::size_t header_bytes, const BrickMapShape& shape) {
  BrickMapLayout layout{};
  layout.directory = align_array(header_bytes);
  layout.lookup = align_array(layout.directory + shape.brick_slots * sizeof(std::int32_t));
  layout.columns = align_array(layout.lookup + shape.brick_count * kBrickCells * sizeof(std::int32_t));
  layout.records = align_array(layout.columns + shape.brick_count * sizeof(std::uint64_t));
  layout.bytes = layout.records + shape.record_count * sizeof(VoxelRecord);
  return layout;
}

/// A map to be read.
struct BrickMapView {
  Grid grid;
  std::int64_t stamp_ns = 0;
  PoseRecord T_odom_base{};  ///< At the stamp.
  BrickMapShape shape;
  const std::int32_t* directory = nullptr;
  const std::int32_t* lookup = nullptr;
  const std::uint64_t* columns = nullptr;
  const VoxelRecord* records = nullptr;
  /// Where the four arrays lie in one piece of memory, in this order, its size is here; else 0. A device
  /// then fetches them in one copy.
  std::size_t bytes_in_one = 0;

  /// The brick at world brick coordinates, or -1 where the grid or its touched part does not reach.
  [[nodiscard]] GVOM_HD std::int32_t brick_at(const Int3& world_brick) const {
    const std::int32_t slot = grid.slot_of_brick(world_brick);
    return slot < 0 ? -1 : directory[slot];
  }

  /// What the map says of a world voxel; without hits `min_height_m` is +infinity.
  [[nodiscard]] VoxelRecord voxel_at(const Int3& world) const {
    const std::int32_t brick =
        brick_at({floor_to_brick(world[0]) / kBrickEdge, floor_to_brick(world[1]) / kBrickEdge,
                  floor_to_brick(world[2]) / kBrickEdge});
    if (brick < 0) return {0, 0, std::numeric_limits<float>::infinity()};
    const std::int32_t value =
        lookup[static_cast<std::size_t>(brick) * kBrickCells + cell_in_brick(world[0], world[1], world[2])];
    if (value >= 0) return records[value];
    return {0, passes_of(value), std::numeric_limits<float>::infinity()};
  }
};

}  // namespace gvom
