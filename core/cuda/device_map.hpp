// Buffer maps and fused map as kernels see them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/format/brick_map.hpp"
#include "core/fused_view.hpp"

namespace gvom::cuda {

/// A buffer map of the window; pointers of the device.
struct DeviceMap {
  Grid grid;
  std::int64_t stamp_ns;
  const std::int32_t* directory;
  const std::int32_t* lookup;
  const std::uint64_t* columns;
  const float* lowest_ray_m;
  const VoxelRecord* records;
  /// For each stack of the grid's bricks, [y][x]: which of its 64 columns have an observed voxel in the fused
  /// map's reach. The device keeps it up to date.
  std::uint64_t* observed;

  /// The brick at world brick coordinates, or -1.
  GVOM_HD std::int32_t brick_at(const Int3& world_brick) const {
    const std::int32_t slot = grid.slot_of_brick(world_brick);
    return slot < 0 ? -1 : directory[slot];
  }
  /// The lookup values of a brick's voxels.
  [[nodiscard]] GVOM_HD const std::int32_t* lookup_of(std::int32_t brick) const {
    return lookup + static_cast<std::size_t>(brick) * kBrickCells;
  }
  /// Of the 64 columns of a stack of bricks (R5a), or nullptr where the map does not reach.
  [[nodiscard]] GVOM_HD const float* lowest_rays_of(std::int32_t bx, std::int32_t by) const {
    const std::int32_t stack = grid.stack_of_brick(bx, by);
    return stack < 0 ? nullptr : lowest_ray_m + std::ptrdiff_t{stack} * kBrickColumns;
  }
};

/// Dense bricks, addressed toroidally: those of the fused map, or of one sweep in the making.
struct DenseBricks {
  Int3 bricks;  ///< Of the grid, per axis.
  std::uint32_t* hits;
  std::uint32_t* passes;
  float* min_height_m;
  /// For each column of each brick, bit z: the voxel is not of the window but shows what is remembered (R17).
  /// Null where nothing is.
  std::uint8_t* shown = nullptr;

  /// The byte of `shown` of the column whose cells begin there.
  [[nodiscard]] GVOM_HD std::uint8_t shown_in(std::size_t begin) const {
    return shown == nullptr ? std::uint8_t{0} : shown[begin / kBrickEdge];
  }

  /// Where the cells of a world brick begin.
  GVOM_HD std::size_t begin_of(const Int3& world_brick) const {
    return std::size_t{brick_slot(wrap(world_brick[0], bricks[0]), wrap(world_brick[1], bricks[1]),
                                  wrap(world_brick[2], bricks[2]), bricks[0], bricks[1])} *
           kBrickCells;
  }
};

/// The world brick in a slot of a grid.
GVOM_HD inline Int3 world_brick(const Grid& grid, std::int32_t slot) {
  const Int3 n = grid.bricks();
  return {grid.origin[0] / kBrickEdge + slot % n[0], grid.origin[1] / kBrickEdge + slot / n[0] % n[1],
          grid.origin[2] / kBrickEdge + slot / (n[0] * n[1])};
}

/// Eight values that lie side by side: what a column of a brick has. Read and written in wide accesses.
template <class T>
struct alignas(sizeof(T) < 4 ? sizeof(T) * kBrickEdge : 32) Eight {
  T at[kBrickEdge];
};
static_assert(sizeof(Eight<float>) == 32 && sizeof(Eight<std::uint16_t>) == 16);

template <class T>
GVOM_HD inline Eight<T> read_eight(const T* begin) {
  return *reinterpret_cast<const Eight<T>*>(begin);
}
template <class T>
GVOM_HD inline void write_eight(T* begin, const Eight<T>& values) {
  *reinterpret_cast<Eight<T>*>(begin) = values;
}

}  // namespace gvom::cuda
