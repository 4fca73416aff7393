// The steps from dense bricks to a brick map (R6).
#pragma once

#include <cuda_runtime.h>

#include "core/cuda/device_map.hpp"

namespace gvom::cuda {

/// Number of set bits.
__device__ inline std::uint32_t count_bits(std::uint64_t bits) {
  return static_cast<std::uint32_t>(__popcll(bits));
}

/// What BrickWriter's kernels share.
struct BrickWork {
  Grid grid;
  DenseBricks bricks;
  std::uint8_t* observed;
  std::uint8_t* hit;
  std::uint64_t* sizes;
  std::uint64_t* starts;

  [[nodiscard]] __device__ std::size_t cells_of(std::int32_t slot) const {
    return bricks.begin_of(world_brick(grid, slot));
  }
  [[nodiscard]] __device__ bool has_brick(std::int32_t slot) const { return sizes[slot] >> 32 != 0; }
  [[nodiscard]] __device__ std::uint32_t brick_of(std::int32_t slot) const {
    return static_cast<std::uint32_t>(starts[slot] >> 32);
  }
  [[nodiscard]] __device__ std::uint32_t first_record_of(std::int32_t slot) const {
    return static_cast<std::uint32_t>(starts[slot]);
  }
};

/// For each column of each slot: which of its voxels were observed, which have hits.
struct MeasureColumns {
  BrickWork work;

  __device__ void operator()(std::int32_t i) const {
    const std::size_t begin = work.cells_of(i / 64) + static_cast<std::size_t>(i % 64 * kBrickEdge);
    const Eight<std::uint32_t> hits = read_eight(work.bricks.hits + begin);
    const Eight<std::uint32_t> passes = read_eight(work.bricks.passes + begin);
    const unsigned of_window = ~unsigned{work.bricks.shown_in(begin)};
    unsigned observed = 0, hit = 0;
    for (int z = 0; z < kBrickEdge; ++z) {
      observed |= static_cast<unsigned>((hits.at[z] | passes.at[z]) != 0) << z;
      hit |= static_cast<unsigned>(hits.at[z] != 0) << z;
    }
    work.observed[i] = static_cast<std::uint8_t>(observed & of_window);
    work.hit[i] = static_cast<std::uint8_t>(hit & of_window);
  }
};

/// For each slot: whether it has a brick and how many records. One more stands for the end.
struct MeasureBricks {
  BrickWork work;
  std::int32_t slots;

  __device__ void operator()(std::int32_t slot) const {
    std::uint64_t size = 0;
    if (slot < slots) {
      const auto* observed = reinterpret_cast<const std::uint64_t*>(work.observed) + slot * 8;
      const auto* hit = reinterpret_cast<const std::uint64_t*>(work.hit) + slot * 8;
      std::uint64_t any = 0;
      for (int word = 0; word < 8; ++word) any |= observed[word], size += count_bits(hit[word]);
      size |= std::uint64_t{any != 0} << 32;
    }
    work.sizes[slot] = size;
  }
};

/// For each slot: its entry in the directory, and which of its columns were observed.
struct WriteDirectory {
  BrickWork work;
  BrickMapArrays out;

  __device__ void operator()(std::int32_t slot) const {
    out.directory[slot] = work.has_brick(slot) ? static_cast<std::int32_t>(work.brick_of(slot)) : -1;
    if (!work.has_brick(slot)) return;
    std::uint64_t columns = 0;
    for (int column = 0; column < 64; ++column)
      columns |= std::uint64_t{work.observed[slot * 64 + column] != 0} << column;
    out.columns[work.brick_of(slot)] = columns;
  }
};

/// For each column of each slot that has a brick: lookup values and records.
struct WriteColumns {
  BrickWork work;
  BrickMapArrays out;

  __device__ void operator()(std::int32_t i) const {
    const std::int32_t slot = i / 64, column = i % 64;
    if (!work.has_brick(slot)) return;
    const std::size_t begin = work.cells_of(slot) + static_cast<std::size_t>(column * kBrickEdge);
    const Eight<std::uint32_t> hits = read_eight(work.bricks.hits + begin);
    const Eight<std::uint32_t> passes = read_eight(work.bricks.passes + begin);
    std::uint32_t record = work.first_record_of(slot) + records_before(slot, column);
    Eight<std::int32_t> lookup;
    const unsigned shown = work.bricks.shown_in(begin);
    for (int z = 0; z < kBrickEdge; ++z) {
      const bool of_window = (shown >> z & 1) == 0;
      lookup.at[z] = free_lookup(of_window ? passes.at[z] : 0);
      if (hits.at[z] == 0 || !of_window) continue;
      out.records[record] = {hits.at[z], passes.at[z], work.bricks.min_height_m[begin + z]};
      lookup.at[z] = static_cast<std::int32_t>(record++);
    }
    const std::size_t brick = work.brick_of(slot);
    write_eight(out.lookup + brick * kBrickCells + static_cast<std::size_t>(column * kBrickEdge), lookup);
  }

 private:
  /// Of the brick's columns before this one.
  __device__ std::uint32_t records_before(std::int32_t slot, std::int32_t column) const {
    const auto* hit = reinterpret_cast<const std::uint64_t*>(work.hit) + slot * 8;
    std::uint32_t records = 0;
    for (int word = 0; word < column / 8; ++word) records += count_bits(hit[word]);
    const int rest = column % 8 * 8;
    if (rest > 0) records += count_bits(hit[column / 8] & ((std::uint64_t{1} << rest) - 1));
    return records;
  }
};

}  // namespace gvom::cuda
