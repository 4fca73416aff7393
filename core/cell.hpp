// What happens to one voxel of the fused map when a map comes or leaves (R7, R8), for host and device.
#pragma once

#include <cstdint>
#include <limits>

#include "core/format/brick_map.hpp"

namespace gvom {

/// `min_height_m` of a fused voxel without hits.
inline constexpr float kNoHeight_m = std::numeric_limits<float>::infinity();

/// Passes of a buffer map's voxel that has no hits; 0 of one that has (its record says them).
GVOM_HD inline std::uint32_t free_passes(std::int32_t lookup) {
  return static_cast<std::uint32_t>(~lookup & (lookup >> 31));
}

/// The lower height; both are numbers.
GVOM_HD inline float lower(float a_m, float b_m) {
  return b_m < a_m ? b_m : a_m;
}

/// A fused voxel where it lies.
struct FusedCell {
  std::uint32_t& hits;
  std::uint32_t& passes;
  float& min_height_m;
};

/// Adds what a map's record says (R7).
GVOM_HD inline void add_record(const VoxelRecord& record, const FusedCell& cell) {
  cell.hits += record.hits;
  cell.passes += record.passes;
  cell.min_height_m = lower(cell.min_height_m, record.min_height_m);
}

/// Takes out what a map's record said (R7). True: the minimum left with it and the voxel still has hits, so
/// `min_height_m` has to be looked up in the window's maps.
GVOM_HD inline bool subtract_record(const VoxelRecord& record, const FusedCell& cell) {
  cell.hits -= record.hits;
  cell.passes -= record.passes;
  if (cell.hits == 0) cell.min_height_m = kNoHeight_m;
  return cell.hits != 0 && record.min_height_m == cell.min_height_m;
}

/// R8.
GVOM_HD inline bool is_occupied(std::uint32_t hits, std::uint32_t min_hits) {
  return hits >= min_hits;
}
/// A voxel that was hit once in so many passes is no ground (R8): dust, a blade that moves.
inline constexpr std::uint64_t kMostPassesPerHit = 64;
GVOM_HD inline bool is_worn(std::uint32_t hits, std::uint32_t passes) {
  return passes > kMostPassesPerHit * std::uint64_t{hits};
}
GVOM_HD inline bool is_free(std::uint32_t hits, std::uint32_t passes, std::uint32_t min_hits) {
  return (hits | passes) != 0 && !is_occupied(hits, min_hits);
}

}  // namespace gvom
