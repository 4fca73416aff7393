// The voxel grid of one map (R1): world voxels, grid origin, bricks.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/config.hpp"
#include "core/platform.hpp"

namespace gvom {

/// x, y, z in voxels or in bricks.
using Int3 = std::array<std::int32_t, 3>;

/// World voxel that holds a coordinate, per axis (R1). A division, not a product with the reciprocal:
/// the two differ for some coordinates on a voxel's face.
GVOM_HD inline double voxel_coordinate(double coordinate_m, double resolution_m) {
  return coordinate_m / resolution_m;
}

/// Rounds down to a multiple of the brick edge, towards minus infinity.
GVOM_HD inline std::int32_t floor_to_brick(std::int32_t voxel) {
  return voxel & ~(kBrickEdge - 1);
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

/// Where a map lies: it holds the world voxels `v` with `0 <= v - origin < size`.
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
  [[nodiscard]] bool same_shape(const Grid& other) const {
    return size == other.size && resolution_m == other.resolution_m;
  }
};

/// The grid of a map made with the vehicle at `base_position_m` in odom (R1).
inline Grid grid_around(const MapConfig& config, const Eigen::Vector3d& base_position_m) {
  Grid grid;
  grid.size = {config.size_xy, config.size_xy, config.size_z};
  grid.resolution_m = {config.resolution_xy_m, config.resolution_xy_m, config.resolution_z_m};
  for (int a = 0; a < 3; ++a) {
    const double voxel = std::floor(voxel_coordinate(base_position_m[a], grid.resolution_m[a]));
    grid.origin[a] = floor_to_brick(static_cast<std::int32_t>(voxel) - grid.size[a] / 2);
  }
  return grid;
}

}  // namespace gvom
