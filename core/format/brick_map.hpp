// Voxels of a grid in bricks, with the paper's pair of lookup and data (R6). Views only: the memory is
// the caller's, usually a chunk of shared memory.
#pragma once

#include <cmath>
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

inline constexpr VoxelRecord kUnknownVoxel = {0, 0, std::numeric_limits<float>::infinity()};

/// Lookup value of a voxel that is not occupied, and back: -1 - passes (R6), which is the complement.
GVOM_HD inline std::int32_t free_lookup(std::uint32_t passes) {
  return static_cast<std::int32_t>(~passes);
}
GVOM_HD inline std::uint32_t passes_of(std::int32_t lookup) {
  return ~static_cast<std::uint32_t>(lookup);
}

/// The lowest point of a ray (R5a) in a column that no ray has left.
inline constexpr float kNoRay_m = std::numeric_limits<float>::infinity();

/// How many elements a map's arrays have.
struct BrickMapShape {
  std::uint32_t brick_slots = 0;   ///< Bricks of the whole grid.
  std::uint32_t brick_count = 0;   ///< Bricks with an observed voxel.
  std::uint32_t record_count = 0;  ///< Voxels with hits.
  std::uint32_t column_count = 0;  ///< Columns of the whole grid.
};

/// The arrays of a map to be written.
struct BrickMapArrays {
  std::int32_t* directory;  ///< [brick_slots], slot = (bz * ny + by) * nx + bx: brick or -1.
  std::int32_t* lookup;     ///< [brick_count * 512], cell = (x * 8 + y) * 8 + z: record, or -1 - passes.
  std::uint64_t* columns;   ///< [brick_count], bit x * 8 + y: the brick's column has an observed voxel.
  float* lowest_ray_m;   ///< [column_count], column_in_stacks: the lowest point of a ray (R5a), or +infinity.
  VoxelRecord* records;  ///< [record_count], in the order of bricks and cells.
};

/// Where the arrays lie in one piece of memory, bytes from its start; each is aligned to 64.
struct BrickMapLayout {
  std::size_t directory;
  std::size_t lookup;
  std::size_t columns;
  std::size_t lowest_ray;
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
  layout.lowest_ray = align_array(layout.columns + shape.brick_count * sizeof(std::uint64_t));
  layout.records = align_array(layout.lowest_ray + shape.column_count * sizeof(float));
  layout.bytes = layout.records + shape.record_count * sizeof(VoxelRecord);
  return layout;
}

/// The lookup value of a world voxel; that of an unobserved one where the grid does not reach.
template <class Map>
GVOM_HD std::int32_t lookup_at(const Map& map, const Int3& world) {
  const std::int32_t brick = map.brick_at(brick_of(world));
  if (brick < 0) return free_lookup(0);
  return map.lookup_of(brick)[cell_in_brick(world[0], world[1], world[2])];
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
  const float* lowest_ray_m = nullptr;
  const VoxelRecord* records = nullptr;
  /// Where the five arrays lie in one piece of memory, in this order, its size is here; else 0. A device
  /// then fetches them in one copy.
  std::size_t bytes_in_one = 0;

  /// The brick at world brick coordinates, or -1 where the grid or its touched part does not reach.
  [[nodiscard]] GVOM_HD std::int32_t brick_at(const Int3& world_brick) const {
    const std::int32_t slot = grid.slot_of_brick(world_brick);
    return slot < 0 ? -1 : directory[slot];
  }

  /// The lookup values of a brick's voxels.
  [[nodiscard]] GVOM_HD const std::int32_t* lookup_of(std::int32_t brick) const {
    return lookup + static_cast<std::size_t>(brick) * kBrickCells;
  }

  /// What the map says of a world voxel; without hits `min_height_m` is +infinity, without hits and passes
  /// the voxel is unknown, as it is where the grid does not reach.
  [[nodiscard]] VoxelRecord voxel_at(const Int3& world) const {
    const std::int32_t value = lookup_at(*this, world);
    if (value >= 0) return records[value];
    return {0, passes_of(value), kUnknownVoxel.min_height_m};
  }

  /// The same of the voxel that holds a point in odom.
  [[nodiscard]] VoxelRecord voxel_at_m(double x_m, double y_m, double z_m) const {
    const double point_m[3] = {x_m, y_m, z_m};
    Int3 world{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double voxel = std::floor(voxel_coordinate(point_m[a], grid.resolution_m[a]));
      const double from_origin = voxel - grid.origin[a];
      const bool inside = from_origin >= 0 && from_origin < grid.size[a];
      if (!inside) return kUnknownVoxel;
      world[a] = static_cast<std::int32_t>(voxel);
    }
    return voxel_at(world);
  }

  /// Calls `visit(const Int3& world, const VoxelRecord&)` for each voxel with hits, brick by brick.
  template <class Visit>
  void for_each_hit(Visit&& visit) const {
    const Int3 n = grid.bricks();
    for (std::uint32_t slot = 0; slot < shape.brick_slots; ++slot) {
      if (directory[slot] < 0) continue;
      const auto s = static_cast<std::int32_t>(slot);
      const Int3 corner = {grid.origin[0] + s % n[0] * kBrickEdge,
                           grid.origin[1] + s / n[0] % n[1] * kBrickEdge,
                           grid.origin[2] + s / (n[0] * n[1]) * kBrickEdge};
      const std::int32_t* cells = lookup_of(directory[slot]);
      for (std::int32_t i = 0; i < kBrickCells; ++i)
        if (cells[i] >= 0)
          visit(Int3{corner[0] + i / kBrickColumns, corner[1] + i / kBrickEdge % kBrickEdge,
                     corner[2] + i % kBrickEdge},
                records[cells[i]]);
    }
  }
};

}  // namespace gvom
