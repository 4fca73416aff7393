// What is remembered of maps that left the window, and shown where it observes nothing (R17).
#pragma once

#include "core/cuda/fuse_kernels.hpp"
#include "core/cuda/lowest_ray_kernels.hpp"

namespace gvom::cuda {

/// The columns that a map observed in its bricks of a stack with z from `low` up to but without `high`. A
/// lane looks at each: no grid has more.
__device__ inline std::uint64_t columns_in_bricks(const DeviceMap& map, std::int32_t bx, std::int32_t by,
                                                  std::int32_t low, std::int32_t high) {
  return bits_of_lanes([&](std::int32_t lane) {
    const std::int32_t brick = low + lane < high ? map.brick_at({bx, by, low + lane}) : -1;
    return brick >= 0 ? map.columns[brick] : std::uint64_t{0};
  });
}

/// What is remembered of eight voxels above each other.
struct RememberedColumn {
  Eight<RememberedHits> hits;
  Eight<RememberedPasses> passes;
  std::uint8_t left = 0;  ///< Bit z: a map that left had observed the voxel.

  __device__ void clear() {
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z) hits.at[z] = kNoHits, passes.at[z] = 0;
  }
  /// But for what is too old.
  __device__ void read(const DeviceMemory& memory, std::size_t begin, const MemoryTick& tick) {
    hits = read_eight(memory.hits + begin);
    passes = read_eight(memory.passes + begin);
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z) {
      if (tick.is_too_old(hits.at[z].beat())) hits.at[z] = kNoHits;
      if (tick.is_too_old(beat_in(passes.at[z]))) passes.at[z] = 0;
    }
  }
  __device__ void write(const DeviceMemory& memory, std::size_t begin) const {
    write_eight(memory.hits + begin, hits);
    write_eight(memory.passes + begin, passes);
  }

  /// @param lower the map observed a voxel of the column in a lower brick
  __device__ void add(const DeviceMap& map, const Eight<std::int32_t>& lookup, bool lower,
                      const MemoryTick& tick) {
    unsigned hit = 0, passed = 0;
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z) {
      hit |= static_cast<unsigned>(lookup.at[z] >= 0) << z;
      passed |= static_cast<unsigned>(free_passes(lookup.at[z]) != 0) << z;
    }
    left |= static_cast<std::uint8_t>(hit | passed);
    const std::int64_t beat = beat_of(map.stamp_ns);
    if (tick.now - beat > tick.beats) return;
    const auto last = static_cast<std::uint8_t>(beat), now = static_cast<std::uint8_t>(tick.now);
    const std::uint8_t telling =
        telling_passes(static_cast<std::uint8_t>(hit), static_cast<std::uint8_t>(passed), lower);
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z) {
      if ((hit >> z & 1) != 0) hits.at[z] = with_record(hits.at[z], map.records[lookup.at[z]], last, now);
      if ((telling >> z & 1) != 0)
        passes.at[z] = with_passes(passes.at[z], rememberable(free_passes(lookup.at[z])), last, now);
    }
  }

  /// The age of the oldest beat, or -1.
  [[nodiscard]] __device__ std::int32_t oldest_age(std::uint8_t now) const {
    std::int32_t oldest = -1;
    const auto note = [&](std::uint8_t beat) {
      const std::int32_t age = beats_between(beat, now);
      oldest = age > oldest ? age : oldest;
    };
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z) {
      if (hits.at[z].bits != 0) note(hits.at[z].beat());
      if (passes.at[z] != 0) note(beat_in(passes.at[z]));
    }
    return oldest;
  }
};

/// For each half of a listed brick, after UpdateBricks, a lane for each of its 32 columns: remembers the maps
/// that left, forgets what is too old, and shows what the window does not observe.
struct UpdateMemory {
  const FuseTick* tick;
  const std::uint32_t* listed;
  DenseBricks bricks;
  DeviceMemory memory;
  std::uint8_t* occupied;  ///< The masks of FusedView, as bytes.
  std::uint8_t* free;
  std::int32_t mask_bytes;  ///< Of a column.
  std::uint32_t min_hits;

  static constexpr std::int32_t kPerBrick = UpdateBricks::kPerBrick;

  __device__ void operator()(std::int32_t i) const {
    const Int3 brick = world_brick(tick->grid, static_cast<std::int32_t>(listed[i / kPerBrick]));
    const std::int32_t half = i % kPerBrick, first = half * kLanes;
    const std::size_t begin = bricks.begin_of(brick) + static_cast<std::size_t>(first) * kBrickEdge;
    const bool enters = tick->enters(brick);
    PerLane<RememberedColumn> columns;
    for_each_lane([&](std::int32_t lane) {
      columns[lane].clear();
      if (!enters) columns[lane].read(memory, cells_of(begin, lane), tick->memory);
    });
    for (std::int32_t m = 0; m < tick->left_maps; ++m) remember(tick->left(m), brick, first, columns);
    for_each_lane([&](std::int32_t lane) {
      columns[lane].write(memory, cells_of(begin, lane));
      show(brick, first + lane, cells_of(begin, lane), enters, columns[lane]);
    });
    const std::int32_t oldest = highest_of_lanes([&](std::int32_t lane) {
      return columns[lane].oldest_age(static_cast<std::uint8_t>(tick->memory.now));
    });
    in_lane(0, [&] {
      memory.oldest[DeviceMemory::half_of(bricks.bricks, brick) + static_cast<std::size_t>(half)] =
          DeviceMemory::kept(oldest, tick->memory.now);
    });
  }

 private:
  [[nodiscard]] __device__ static std::size_t cells_of(std::size_t begin, std::int32_t lane) {
    return begin + static_cast<std::size_t>(lane) * kBrickEdge;
  }

  __device__ void remember(const DeviceMap& map, const Int3& brick, std::int32_t first,
                           PerLane<RememberedColumn>& columns) const {
    const std::int32_t index = map.brick_at(brick);
    if (index < 0) return;
    const std::uint64_t lower =
        columns_in_bricks(map, brick[0], brick[1], map.grid.origin[2] / kBrickEdge, brick[2]);
    const std::int32_t* const lookup = map.lookup_of(index);
    for_each_lane([&](std::int32_t lane) {
      const MapBrick of_map{lookup, map.records};
      columns[lane].add(map, of_map.column(first + lane), (lower >> (first + lane) & 1) != 0, tick->memory);
    });
  }

  __device__ void show(const Int3& brick, std::int32_t column, std::size_t begin, bool enters,
                       const RememberedColumn& remembered) const {
    const unsigned before = enters ? 0U : bricks.shown[begin / kBrickEdge];
    const unsigned candidates = before | remembered.left;
    const std::size_t byte = mask_byte(tick->grid, brick, column, mask_bytes);
    const unsigned silent = candidates & ~(unsigned{occupied[byte]} | free[byte]);
    unsigned shown = 0, hit = 0;
    GVOM_UNROLL
    for (int z = 0; z < kBrickEdge; ++z) {
      if ((silent >> z & 1) == 0) continue;
      const VoxelRecord voxel = shown_voxel(remembered.hits.at[z], remembered.passes.at[z],
                                            static_cast<std::uint8_t>(tick->memory.now));
      if ((voxel.hits | voxel.passes) == 0) continue;
      shown |= 1U << z;
      hit |= static_cast<unsigned>(is_occupied(voxel.hits, min_hits)) << z;
      bricks.hits[begin + static_cast<std::size_t>(z)] = voxel.hits;
      bricks.passes[begin + static_cast<std::size_t>(z)] = voxel.passes;
      bricks.min_height_m[begin + static_cast<std::size_t>(z)] = voxel.min_height_m;
    }
    bricks.shown[begin / kBrickEdge] = static_cast<std::uint8_t>(shown);
    reinterpret_cast<std::uint8_t*>(memory.remembered)[byte] = static_cast<std::uint8_t>(shown);
    if (shown == 0) return;
    occupied[byte] |= static_cast<std::uint8_t>(hit);
    free[byte] |= static_cast<std::uint8_t>(shown & ~hit);
  }
};

/// For each stack of the grid's bricks, two of its columns for a lane: in which beat a map that left had
/// observed each, and how low rays were.
struct RememberStacks {
  const FuseTick* tick;
  DeviceMemory memory;

  __device__ void operator()(std::int32_t stack) const {
    const Int3 brick = world_brick(tick->grid, stack);
    const std::size_t first = first_of_stack(brick, tick->grid.bricks()[0]);
    const bool enters = tick->before.stack_of_brick(brick[0], brick[1]) < 0;
    for_each_lane([&](std::int32_t lane) {
      for_each_half([&](std::int32_t half) { begin(first + column(lane, half), enters); });
    });
    for (std::int32_t m = 0; m < tick->left_maps; ++m) {
      const DeviceMap& map = tick->left(m);
      const std::int32_t low = map.grid.origin[2] / kBrickEdge;
      const std::uint64_t seen = columns_in_bricks(map, brick[0], brick[1], low, low + map.grid.bricks()[2]);
      const float* const rays_m = map.lowest_rays_of(brick[0], brick[1]);
      for_each_lane([&](std::int32_t lane) {
        for_each_half([&](std::int32_t half) {
          const std::size_t c = column(lane, half);
          if ((seen >> c & 1) != 0) note_beat(map, first + c);
          if (rays_m != nullptr)
            lower_span(map, first + c, rays_m[c] + doubt_of_rays_m(map.grid, brick[0], brick[1]));
        });
      });
    }
  }

 private:
  [[nodiscard]] __device__ static std::size_t column(std::int32_t lane, std::int32_t half) {
    return static_cast<std::size_t>(lane + half * kLanes);
  }
  template <class Step>
  __device__ static void for_each_half(Step&& step) {
    GVOM_UNROLL
    for (std::int32_t half = 0; half < kBrickColumns / kLanes; ++half) step(half);
  }
  [[nodiscard]] __device__ float* span(std::int64_t number) const {
    const std::int64_t place = (number % kSpans + kSpans) % kSpans;
    return memory.spans_m + static_cast<std::size_t>(place) * tick->grid.columns();
  }

  __device__ void begin(std::size_t column, bool enters) const {
    const MemoryTick& now = tick->memory;
    std::uint8_t& beat = memory.column_beats[column];
    if (enters || now.is_too_old(beat)) beat = static_cast<std::uint8_t>(now.now - now.beats - 1);
    if (!enters && now.spans_passed == 0) return;
    const std::int64_t newest = span_of(now.now, now.beats);
    float lowest_m = kNoRay_m;
    for (std::int32_t back = 0; back < kSpans; ++back) {
      float& span_m = span(newest - back)[column];
      if (enters || back < now.spans_passed) span_m = kNoRay_m;
      lowest_m = lower(lowest_m, span_m);
    }
    memory.lowest_ray_m[column] = lowest_m;
  }

  __device__ void note_beat(const DeviceMap& map, std::size_t column) const {
    const std::int64_t now = tick->memory.now, beat = beat_of(map.stamp_ns);
    if (now - beat > tick->memory.beats) return;
    std::uint8_t& newest = memory.column_beats[column];
    if (now - beat < beats_between(newest, static_cast<std::uint8_t>(now)))
      newest = static_cast<std::uint8_t>(beat);
  }

  __device__ void lower_span(const DeviceMap& map, std::size_t column, float ray_m) const {
    const std::int32_t beats = tick->memory.beats;
    const std::int64_t own = span_of(beat_of(map.stamp_ns), beats);
    if (span_of(tick->memory.now, beats) - own >= kSpans) return;
    float& span_m = span(own)[column];
    span_m = lower(span_m, ray_m);
    memory.lowest_ray_m[column] = lower(memory.lowest_ray_m[column], ray_m);
  }
};

}  // namespace gvom::cuda
