// Voxels in the plainest form: a list of those observed, or a dense box; and a height for each column.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/grid.hpp"

namespace gvom::oracle {

struct Voxel {
  std::uint32_t hits = 0;
  std::uint32_t passes = 0;
  float min_height_m = std::numeric_limits<float>::infinity();
  bool remembered = false;  ///< Not of the window (R17), but of a beat:
  std::int64_t beat = 0;
  std::uint32_t told_hits = 0;  ///< Of maps that left; also where the window has passes.
  float told_height_m = std::numeric_limits<float>::infinity();

  [[nodiscard]] bool observed() const { return hits > 0 || passes > 0; }
};

/// An observed voxel; `at` is its world voxel (R1).
struct WorldVoxel {
  Int3 at;
  Voxel voxel;
};

/// All voxels of a grid, by world voxel.
class VoxelBox {
 public:
  explicit VoxelBox(const Grid& grid)
      : grid_(grid),
        voxels_(std::size_t(grid.size[0]) * std::size_t(grid.size[1]) * std::size_t(grid.size[2])) {}

  [[nodiscard]] const Grid& grid() const { return grid_; }

  [[nodiscard]] bool holds(const Int3& world) const {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t local = std::int64_t{world[a]} - grid_.origin[a];
      if (local < 0 || local >= grid_.size[a]) return false;
    }
    return true;
  }

  Voxel& operator[](const Int3& world) { return voxels_[index(world)]; }
  const Voxel& operator[](const Int3& world) const { return voxels_[index(world)]; }

  /// The voxel at x, y, z from the origin.
  [[nodiscard]] const Voxel& local(int x, int y, int z) const {
    return (*this)[{grid_.origin[0] + x, grid_.origin[1] + y, grid_.origin[2] + z}];
  }

 private:
  [[nodiscard]] std::size_t index(const Int3& world) const {
    const auto x = std::size_t(world[0] - grid_.origin[0]);
    const auto y = std::size_t(world[1] - grid_.origin[1]);
    const auto z = std::size_t(world[2] - grid_.origin[2]);
    return (y * std::size_t(grid_.size[0]) + x) * std::size_t(grid_.size[2]) + z;
  }

  Grid grid_;
  std::vector<Voxel> voxels_;
};

/// A height for each column of a grid, [y][x].
struct ColumnHeights {
  Grid grid;
  std::vector<float> at_m;

  /// None anywhere.
  explicit ColumnHeights(const Grid& of)
      : grid(of),
        at_m(std::size_t(of.size[0]) * std::size_t(of.size[1]), std::numeric_limits<float>::infinity()) {}

  /// That of the column at x, y from the origin; null beyond the grid.
  float* at(std::int64_t x, std::int64_t y) {
    const bool inside = x >= 0 && y >= 0 && x < grid.size[0] && y < grid.size[1];
    return inside ? &at_m[std::size_t(y) * std::size_t(grid.size[0]) + std::size_t(x)] : nullptr;
  }
};

}  // namespace gvom::oracle
