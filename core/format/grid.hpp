// Where a map lies: world voxels, bricks, cells (R1).
#pragma once

#include <array>
#include <cstdint>

#include "core/format/platform.hpp"

namespace gvom {

/// The edge of a brick, the unit of storage and transfer, in voxels (R1).
inline constexpr int kBrickEdge = 8;
inline constexpr int kBrickColumns = kBrickEdge * kBrickEdge;
inline constexpr int kBrickCells = kBrickColumns * kBrickEdge;

/// The most lidars that a vehicle can have.
inline constexpr int kMaxLidars = 16;

/// x, y, z in voxels or in bricks.
using Int3 = std::array<std::int32_t, 3>;

/// World voxel that holds a coordinate, per axis, before it is rounded down (R1). A division, not a product
/// with the reciprocal: the two differ for some coordinates on a voxel's face.
GVOM_HD inline double voxel_coordinate(double coordinate_m, double resolution_m) {
  return coordinate_m / resolution_m;
}

/// Rounds down to a multiple of the brick edge, towards minus infinity.
GVOM_HD inline std::int32_t floor_to_brick(std::int32_t voxel) {
  return voxel & ~(kBrickEdge - 1);
}

/// The brick of a world voxel.
GVOM_HD inline Int3 brick_of(const Int3& world) {
  return {floor_to_brick(world[0]) / kBrickEdge, floor_to_brick(world[1]) / kBrickEdge,
          floor_to_brick(world[2]) / kBrickEdge};
}

/// Index of a cell within its brick; z runs fastest, so that a column's voxels lie side by side.
GVOM_HD inline std::uint32_t cell_in_brick(std::int32_t x, std::int32_t y, std::int32_t z) {
  return static_cast<std::uint32_t>(((x & 7) << 6) | ((y & 7) << 3) | (z & 7));
}

/// Slot of a brick in a grid's directory.
GVOM_HD inline std::uint32_t brick_slot(std::int32_t bx, std::int32_t by, std::int32_t bz, std::int32_t nx,
                                        std::int32_t ny) {
  return static_cast<std::uint32_t>((bz * ny + by) * nx + bx);
}

/// Index of a column in arrays of a grid's columns: those of a stack of bricks side by side.
GVOM_HD inline std::uint32_t column_in_stacks(std::int32_t x, std::int32_t y, std::int32_t bricks_x) {
  return static_cast<std::uint32_t>((((y >> 3) * bricks_x + (x >> 3)) << 6) | ((x & 7) << 3) | (y & 7));
}

/// A map holds the world voxels `v` with `0 <= v - origin < size`.
struct Grid {
  Int3 origin{};  ///< World voxels, multiples of 8.
  Int3 size{};    ///< Voxels, multiples of 8.
  std::array<double, 3> resolution_m{};

  [[nodiscard]] GVOM_HD Int3 bricks() const {
    return {size[0] / kBrickEdge, size[1] / kBrickEdge, size[2] / kBrickEdge};
  }
  [[nodiscard]] std::uint32_t brick_slots() const {
    const Int3 b = bricks();
    return static_cast<std::uint32_t>(b[0]) * b[1] * b[2];
  }
  [[nodiscard]] GVOM_HD std::uint32_t columns() const {
    return static_cast<std::uint32_t>(size[0]) * static_cast<std::uint32_t>(size[1]);
  }
  /// The slot of a brick at world brick coordinates (voxels / 8), or -1 where the grid does not reach.
  [[nodiscard]] GVOM_HD std::int32_t slot_of_brick(const Int3& world_brick) const {
    const Int3 n = bricks();
    Int3 b{};
    for (std::size_t a = 0; a < 3; ++a) {
      b[a] = world_brick[a] - origin[a] / kBrickEdge;
      if (b[a] < 0 || b[a] >= n[a]) return -1;
    }
    return static_cast<std::int32_t>(brick_slot(b[0], b[1], b[2], n[0], n[1]));
  }
  /// The stack of bricks, a column of them, at world brick coordinates, or -1 where the grid does not reach.
  [[nodiscard]] GVOM_HD std::int32_t stack_of_brick(std::int32_t bx, std::int32_t by) const {
    return slot_of_brick({bx, by, origin[2] / kBrickEdge});
  }
  /// The middle of a world voxel, metres in odom.
  [[nodiscard]] std::array<double, 3> center_m(const Int3& world) const {
    return {(world[0] + 0.5) * resolution_m[0], (world[1] + 0.5) * resolution_m[1],
            (world[2] + 0.5) * resolution_m[2]};
  }
  [[nodiscard]] bool same_shape(const Grid& other) const {
    return size == other.size && resolution_m == other.resolution_m;
  }
};

/// A rigid transform as it is stored and sent, such as `T_odom_base`.
struct PoseRecord {
  double position_m[3];
  double orientation_xyzw[4];  ///< A unit quaternion.
};

}  // namespace gvom
