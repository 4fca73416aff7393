// The ground of all columns (R9), from the text of core/README.md alone.
#pragma once

#include "core/config.hpp"
#include "tests/oracle/columns.hpp"
#include "tests/oracle/fusion.hpp"
#include "tests/oracle/voxels.hpp"

namespace gvom::oracle {

/// What the layers are made of.
struct FusedColumns {
  const MapperConfig& config;
  const VoxelBox& voxels;
  const BufferMap& newest;             ///< Of the window: its pose and stamp are the layers'.
  const Columns<float>& lowest_ray_m;  ///< R5a, with what is remembered (R17).
  const Columns<float>& window_ray_m;  ///< R5a, of the window alone.

  [[nodiscard]] ColumnVoxels column(int x, int y) const { return {config.layers, voxels, x, y}; }
  /// The column's lowest solid voxel (R17), or -1.
  [[nodiscard]] int ground(int x, int y) const { return column(x, y).ground(window_ray_m.at(x, y)); }
  [[nodiscard]] bool grazes_ground(int x, int y) const {
    return column(x, y).grazed(window_ray_m.at(x, y)) >= 0;
  }
  [[nodiscard]] bool remembers_ground(int x, int y) const {
    return grazes_ground(x, y) || (ground(x, y) >= 0 && column(x, y).at(ground(x, y)).remembered);
  }
  /// Of the voxel `ground`.
  [[nodiscard]] float lowest_return_m(int x, int y) const {
    const Voxel& voxel = column(x, y).at(ground(x, y));
    return grazes_ground(x, y) ? voxel.told_height_m : voxel.min_height_m;
  }
};

/// Heights that are not known are +infinity.
struct Ground {
  Columns<float> lowest_m;  ///< `min_height` of the lowest solid voxel.
  Columns<float> known_m;   ///< Seen or assumed ground.
  Columns<float> height_m;
  Columns<YesNo> assumed;
  Columns<YesNo> rim;

  explicit Ground(int n);
};

Ground find_ground(const FusedColumns& map);

}  // namespace gvom::oracle
