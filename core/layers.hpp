// The layers: one value for each column of the fused map (R9..R16).
#pragma once

#include <cstdint>

namespace gvom {

/// Bits of the layer `flags`.
enum ColumnFlag : std::uint8_t { kHard = 1, kSoft = 2, kNegative = 4, kSteep = 8, kAssumed = 16 };

/// Values of the layer `visibility` (R15).
enum class Visibility : std::uint8_t { unobserved = 0, free_only = 1, ground_assumed = 2, ground_seen = 3 };

/// Where layers are written: arrays of n_xy * n_xy values, indexed [y][x] from the grid's origin.
/// Unknown is NaN in float layers.
struct LayerArrays {
  float* height;             ///< m in odom (R9).
  float* inferred_height;    ///< m in odom: the ground is at most this high (R10).
  float* slope_x;            ///< m/m (R12).
  float* slope_y;            ///< m/m (R12).
  float* slope;              ///< rad (R12).
  float* roughness;          ///< m^2 (R12).
  float* obstacle_density;   ///< 0 .. 1 (R11).
  float* negative_delta;     ///< m (R13).
  float* clearance;          ///< m above `height`, +infinity under open sky (R14).
  float* last_seen;          ///< s before the map's stamp (R15).
  std::uint8_t* flags;       ///< ColumnFlag (R9, R11, R12, R13).
  std::uint8_t* visibility;  ///< Visibility (R15).
  std::uint8_t* cost;        ///< costmap_2d convention (R16).
  /// Where all of them lie in one piece of memory with nothing of value between them, `height` first, its
  /// size is here; else 0. A device then delivers them in one copy.
  std::size_t bytes_in_one = 0;
};

}  // namespace gvom
