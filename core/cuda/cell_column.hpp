// Eight fused voxels above each other: a column within a brick, in the registers of one thread (R7, R8).
#pragma once

#include <cuda_runtime.h>

#include "core/cell.hpp"
#include "core/cuda/device_map.hpp"

namespace gvom::cuda {

/// A brick of a map.
struct MapBrick {
  const std::int32_t* lookup;  ///< Of its 512 voxels.
  const VoxelRecord* records;  ///< Of the map.

  /// The lookup values of a column.
  [[nodiscard]] __device__ Eight<std::int32_t> column(std::int32_t column) const {
    return read_eight(lookup + column * kBrickEdge);
  }
};

__device__ inline bool has_record(const Eight<std::int32_t>& lookup) {
  bool any = false;
  GVOM_UNROLL
  for (int z = 0; z < kBrickEdge; ++z) any |= lookup.at[z] >= 0;
  return any;
}

class CellColumn {
 public:
  __device__ void clear() {
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z) hits_.at[z] = 0, passes_.at[z] = 0, min_m_.at[z] = kNoHeight_m;
    has_minima_ = true;
  }

  /// All but the minima: of most columns no tick changes them.
  __device__ void read(const DenseBricks& bricks, std::size_t begin) {
    hits_ = read_eight(bricks.hits + begin);
    passes_ = read_eight(bricks.passes + begin);
  }
  /// Before the first record is added or subtracted.
  __device__ void read_minima(const DenseBricks& bricks, std::size_t begin) {
    if (!has_minima_) min_m_ = read_eight(bricks.min_height_m + begin);
    has_minima_ = true;
  }

  /// Takes out what is not of the window (R17), before anything is added. Bit z of `shown`: that voxel.
  __device__ void hide(const DenseBricks& bricks, std::size_t begin, std::uint8_t shown) {
    if (shown == 0) return;
    read_minima(bricks, begin);
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z)
      if ((shown >> z & 1) != 0) hits_.at[z] = 0, passes_.at[z] = 0, min_m_.at[z] = kNoHeight_m;
  }

  /// What was read and may have changed.
  __device__ void write(const DenseBricks& bricks, std::size_t begin) const {
    write_eight(bricks.passes + begin, passes_);
    if (!has_minima_) return;
    write_eight(bricks.hits + begin, hits_);
    write_eight(bricks.min_height_m + begin, min_m_);
  }

  __device__ void add(const MapBrick& brick, const Eight<std::int32_t>& lookup) {
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z) {
      passes_.at[z] += free_passes(lookup.at[z]);
      if (lookup.at[z] >= 0) add_record(brick.records[lookup.at[z]], cell(z));
    }
  }

  __device__ void subtract(const MapBrick& brick, const Eight<std::int32_t>& lookup) {
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z) {
      passes_.at[z] -= free_passes(lookup.at[z]);
      if (lookup.at[z] >= 0 && subtract_record(brick.records[lookup.at[z]], cell(z))) stale_ |= 1U << z;
    }
  }

  /// Forgets minima that left with a map. Bit z: the voxel still has hits, so its minimum is to be looked up.
  __device__ std::uint32_t forget_stale_minima() {
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z) {
      if (hits_.at[z] == 0) stale_ &= ~(1U << z);
      if ((stale_ >> z & 1) != 0) min_m_.at[z] = kNoHeight_m;
    }
    return stale_;
  }
  __device__ void lower_minima(const Eight<float>& to_m) {
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z) min_m_.at[z] = lower(min_m_.at[z], to_m.at[z]);
  }

  /// Bit z: occupied, free (R8).
  [[nodiscard]] __device__ std::uint8_t occupied(std::uint32_t min_hits) const {
    unsigned bits = 0;
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z)
      bits |= static_cast<unsigned>(is_occupied(hits_.at[z], min_hits)) << z;
    return static_cast<std::uint8_t>(bits);
  }
  [[nodiscard]] __device__ std::uint8_t free(std::uint32_t min_hits) const {
    unsigned bits = 0;
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z)
      bits |= static_cast<unsigned>(is_free(hits_.at[z], passes_.at[z], min_hits)) << z;
    return static_cast<std::uint8_t>(bits);
  }

 private:
  __device__ FusedCell cell(int z) { return {hits_.at[z], passes_.at[z], min_m_.at[z]}; }

  Eight<std::uint32_t> hits_;
  Eight<std::uint32_t> passes_;
  Eight<float> min_m_;
  std::uint32_t stale_ = 0;
  bool has_minima_ = false;
};

}  // namespace gvom::cuda
