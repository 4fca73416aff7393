// Columns in the plainest form: a value for each of a map, and the voxels of one with the rules' words (R8).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "tests/oracle/voxels.hpp"

namespace gvom::oracle {

/// A value for each of n x n columns. Beyond the grid it is `outside`, as everywhere before it is set.
template <class T>
class Columns {
 public:
  Columns(int n, T outside) : n_(n), outside_(outside), values_(std::size_t(n) * std::size_t(n), outside) {}

  [[nodiscard]] int n() const { return n_; }
  [[nodiscard]] T at(int x, int y) const { return inside(x, y) ? values_[index(x, y)] : outside_; }
  void set(int x, int y, T value) { values_[index(x, y)] = value; }
  [[nodiscard]] bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < n_ && y < n_; }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(n_) + std::size_t(x);
  }

  int n_;
  T outside_;
  std::vector<T> values_;
};

enum class YesNo : std::uint8_t { no, yes };

/// Calls `visit(x, y)` for each of n x n columns.
template <class Visit>
void each_column(int n, Visit&& visit) {
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) visit(x, y);
}

/// The voxels of one column, z from the grid's origin.
class ColumnVoxels {
 public:
  ColumnVoxels(const LayersConfig& layers, const VoxelBox& voxels, int x, int y)
      : least_hits_(static_cast<std::uint32_t>(layers.min_hits)), voxels_(voxels), x_(x), y_(y) {}

  [[nodiscard]] int count() const { return voxels_.grid().size[2]; }
  [[nodiscard]] const Voxel& at(int z) const { return voxels_.local(x_, y_, z); }
  [[nodiscard]] bool occupied(int z) const { return z >= 0 && z < count() && at(z).hits >= least_hits_; }
  [[nodiscard]] bool free(int z) const { return at(z).observed() && !occupied(z); }
  [[nodiscard]] bool worn(int z) const {
    return occupied(z) && std::uint64_t{at(z).passes} > 64 * std::uint64_t{at(z).hits};
  }
  [[nodiscard]] bool solid(int z) const { return occupied(z) && !worn(z); }

  /// A voxel that the window's rays graze, which was hit before (R17), or -1.
  [[nodiscard]] int grazed(float window_ray_m) const {
    const int z = lowest(&ColumnVoxels::free), ground = lowest(&ColumnVoxels::solid);
    if (z < 0 || (ground >= 0 && ground < z) || at(z).remembered) return -1;
    return at(z).told_hits >= least_hits_ && window_ray_m >= at(z).told_height_m ? z : -1;
  }

  /// The lowest solid voxel that the rules go by (R17), or -1.
  /// @param window_ray_m the lowest ray of the window in the column
  [[nodiscard]] int ground(float window_ray_m) const {
    if (grazed(window_ray_m) >= 0) return grazed(window_ray_m);
    const int z = lowest(&ColumnVoxels::solid);
    if (z < 0 || !at(z).remembered) return z;
    for (int seen = z + 1; seen < count(); ++seen) {
      if (!solid(seen) || at(seen).remembered) continue;
      const bool hangs = at(seen).min_height_m - window_ray_m > 0.3f;
      return hangs && seen > z + 1 ? z : seen;
    }
    return z;
  }

  /// The lowest voxel that `is` so, or -1.
  [[nodiscard]] int lowest(bool (ColumnVoxels::*is)(int) const) const {
    for (int z = 0; z < count(); ++z)
      if ((this->*is)(z)) return z;
    return -1;
  }

 private:
  std::uint32_t least_hits_;
  const VoxelBox& voxels_;
  int x_, y_;
};

}  // namespace gvom::oracle
