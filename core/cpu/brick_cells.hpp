// Loops over the 512 cells of a brick that decide how long a tick takes.
#pragma once

#include <cstdint>

#include "core/cpu/cell_bits.hpp"

namespace gvom::cpu {

/// Voxels of a buffer map's brick that its rays hit, and the others that they passed.
struct ObservedBits {
  CellBits hit;
  CellBits passed;
};

/// @param lookup [cell], as in a buffer map
ObservedBits observed_in(const std::int32_t* lookup);

/// What fused voxels are (R8).
struct VoxelBits {
  CellBits occupied;
  CellBits free;
  CellBits solid;  ///< Occupied and not worn.
};

/// @param hits, passes [cell], below 2^31
VoxelBits voxel_bits(const std::uint32_t* hits, const std::uint32_t* passes, std::int32_t min_hits);

/// Adds or takes out the passes of a buffer map's free voxels.
void add_free_passes(const std::int32_t* lookup, std::uint32_t* passes);
void subtract_free_passes(const std::int32_t* lookup, std::uint32_t* passes);

/// Voxels whose number is not 0.
CellBits set_in(const std::uint16_t* numbers);

}  // namespace gvom::cpu
