// The layers: one value for each column of the fused map (R9..R16).
#pragma once

#include <cstddef>
#include <cstdint>

namespace gvom {

/// The layers in the order in which they are stored and sent.
enum class LayerId : std::uint32_t {
  height,            ///< m in odom (R9).
  inferred_height,   ///< m in odom: the ground is at most this high (R10).
  slope_x,           ///< m/m (R12).
  slope_y,           ///< m/m (R12).
  slope,             ///< rad (R12).
  roughness,         ///< m^2 (R12).
  obstacle_density,  ///< 0 .. 1 (R11).
  negative_delta,    ///< m (R13).
  clearance,         ///< m above `height`, +infinity under open sky (R14).
  last_seen,         ///< s before the map's stamp (R15).
  flags,             ///< ColumnFlag (R9, R11, R12, R13).
  visibility,        ///< Visibility (R15).
  cost,              ///< costmap_2d convention (R16).
};
inline constexpr int kFloatLayers = 10;  ///< height .. last_seen: float32; the rest uint8.
inline constexpr int kLayers = 13;

/// 4 for float layers, 1 for the others.
constexpr std::size_t layer_value_bytes(LayerId id) {
  return static_cast<int>(id) < kFloatLayers ? sizeof(float) : sizeof(std::uint8_t);
}

/// Bits of the layer `flags`.
enum ColumnFlag : std::uint8_t { kHard = 1, kSoft = 2, kNegative = 4, kSteep = 8, kAssumed = 16 };

/// Values of the layer `visibility` (R15).
enum class Visibility : std::uint8_t {
  unobserved = 0,
  free_only = 1,
  ground_assumed = 2,
  ground_seen = 3,
  remembered = 4,  ///< Of maps older than the window (R17); `last_seen` says how old it is.
};

constexpr bool is_remembered(std::uint8_t visibility) {
  return visibility == static_cast<std::uint8_t>(Visibility::remembered);
}

/// Where layers are written: arrays of n_xy * n_xy values, indexed [y][x] from the grid's origin; each is the
/// LayerId of its name. Unknown is NaN in float layers.
struct LayerArrays {
  float* height;
  float* inferred_height;
  float* slope_x;
  float* slope_y;
  float* slope;
  float* roughness;
  float* obstacle_density;
  float* negative_delta;
  float* clearance;
  float* last_seen;
  std::uint8_t* flags;
  std::uint8_t* visibility;
  std::uint8_t* cost;
  /// Where all of them lie in one piece of memory with nothing of value between them, `height` first, its
  /// size is here; else 0. A device then delivers them in one copy.
  std::size_t bytes_in_one = 0;
};

}  // namespace gvom
