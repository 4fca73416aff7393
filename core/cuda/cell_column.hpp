// Eight fused voxels above each other: a column within a brick, in the registers of one thread (R7, R8).
#pragma once

#include "core/cell.hpp"
#include "core/cuda/device_map.hpp"

namespace gvom::cuda {

/// The lookup values of a column of a map's brick.
__device__ inline Eight<std::int32_t> read_lookup(const DeviceMap& map, std::int32_t brick,
                                                  std::int32_t column) {
  return read_eight(map.lookup + static_cast<std::size_t>(brick) * kBrickCells + column * kBrickEdge);
}

__device__ inline bool has_record(const Eight<std::int32_t>& lookup) {
  bool any = false;
  for (int z = 0; z < kBrickEdge; ++z) any |= lookup.at[z] >= 0;
  return any;
}

class CellColumn {
 public:
  __device__ void clear() {
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

  /// What was read and may have changed.
  __device__ void write(const DenseBricks& bricks, std::size_t begin) const {
    write_eight(bricks.passes + begin, passes_);
    if (!has_minima_) return;
    write_eight(bricks.hits + begin, hits_);
    write_eight(bricks.min_height_m + begin, min_m_);
  }

  __device__ void add(const DeviceMap& map, const Eight<std::int32_t>& lookup) {
    for (int z = 0; z < kBrickEdge; ++z) {
      passes_.at[z] += free_passes(lookup.at[z]);
      if (lookup.at[z] >= 0) add_record(map.records[lookup.at[z]], cell(z));
    }
  }

  __device__ void subtract(const DeviceMap& map, const Eight<std::int32_t>& lookup) {
    for (int z = 0; z < kBrickEdge; ++z) {
      passes_.at[z] -= free_passes(lookup.at[z]);
      if (lookup.at[z] >= 0 && subtract_record(map.records[lookup.at[z]], cell(z))) stale_ |= 1U << z;
    }
  }

  /// Minima that left with a map are to be looked up: now they are unknown, but for a bound.
  __device__ void forget_stale_minima() {
    unseen_hits_ = hits_;
    least_m_ = min_m_;
    for (int z = 0; z < kBrickEdge; ++z) {
      if (hits_.at[z] == 0) stale_ &= ~(1U << z);
      if ((stale_ >> z & 1) != 0) min_m_.at[z] = kNoHeight_m;
    }
  }
  [[nodiscard]] __device__ bool stale() const { return stale_ != 0; }

  /// Looks stale minima up in a map. A voxel is done when all maps that hit it were seen, or none can be
  /// lower.
  __device__ void restore(const DeviceMap& map, const Eight<std::int32_t>& lookup) {
    for (int z = 0; z < kBrickEdge; ++z) {
      if (lookup.at[z] < 0 || (stale_ >> z & 1) == 0) continue;
      const VoxelRecord& record = map.records[lookup.at[z]];
      min_m_.at[z] = lower(min_m_.at[z], record.min_height_m);
      unseen_hits_.at[z] -= record.hits;
      if (unseen_hits_.at[z] == 0 || min_m_.at[z] == least_m_.at[z]) stale_ &= ~(1U << z);
    }
  }

  /// Bit z: occupied, free (R8).
  [[nodiscard]] __device__ std::uint8_t occupied(std::uint32_t min_hits) const {
    unsigned bits = 0;
    for (int z = 0; z < kBrickEdge; ++z)
      bits |= static_cast<unsigned>(is_occupied(hits_.at[z], min_hits)) << z;
    return static_cast<std::uint8_t>(bits);
  }
  [[nodiscard]] __device__ std::uint8_t free(std::uint32_t min_hits) const {
    unsigned bits = 0;
    for (int z = 0; z < kBrickEdge; ++z)
      bits |= static_cast<unsigned>(is_free(hits_.at[z], passes_.at[z], min_hits)) << z;
    return static_cast<std::uint8_t>(bits);
  }

 private:
  __device__ FusedCell cell(int z) { return {hits_.at[z], passes_.at[z], min_m_.at[z]}; }

  Eight<std::uint32_t> hits_;
  Eight<std::uint32_t> passes_;
  Eight<float> min_m_;
  Eight<std::uint32_t> unseen_hits_;
  Eight<float> least_m_;
  std::uint32_t stale_ = 0;
  bool has_minima_ = false;
};

}  // namespace gvom::cuda
