// What a tick does to the fused map, brick by brick and column by column (R7, R8, R15).
#pragma once

#include "core/cuda/atomics.hpp"
#include "core/cuda/cell_column.hpp"
#include "core/cuda/device_memory.hpp"
#include "core/cuda/fuse_tick.hpp"

namespace gvom::cuda {

/// For each 32 slots of the grid: lists those whose brick the tick changes.
struct ListChangedBricks {
  const FuseTick* tick;
  std::int32_t slots;
  DeviceMemory memory;
  std::uint32_t* listed;  ///< Slots, in no order.
  std::uint32_t* count;

  __device__ void operator()(std::int32_t i) const {
    const std::int32_t first = i * kLanes;
    const std::uint32_t changes =
        vote([&](std::int32_t lane) { return first + lane < slots && changed(first + lane); });
    if (changes == 0) return;
    PerLane<std::uint32_t> taken;
    in_lane(0, [&] { taken[0] = take(count, count_lanes(changes)); });
    const std::uint32_t place = of_lane(taken, 0);
    for_each_lane([&](std::int32_t lane) {
      if ((changes >> lane & 1) != 0)
        listed[place + lanes_before(changes, lane)] = static_cast<std::uint32_t>(first + lane);
    });
  }

 private:
  [[nodiscard]] __device__ bool changed(std::int32_t slot) const {
    const Int3 brick = world_brick(tick->grid, slot);
    bool changed = tick->moved_in_z || tick->enters(brick) || tick->map(tick->added).brick_at(brick) >= 0 ||
                   memory.is_due(tick->memory, tick->grid.bricks(), brick);
    for (std::int32_t i = 0; i < tick->left_maps && !changed; ++i)
      changed = tick->left(i).brick_at(brick) >= 0;
    return changed;
  }
};

/// Where a column of a brick has its byte of FusedView's masks. Little-endian, as all machines with CUDA are.
__device__ inline std::size_t mask_byte(const Grid& grid, const Int3& brick, std::int32_t column,
                                        std::int32_t mask_bytes) {
  const Int3 n = grid.bricks();
  const std::int32_t x = wrap(brick[0], n[0]) * kBrickEdge + column / kBrickEdge;
  const std::int32_t y = wrap(brick[1], n[1]) * kBrickEdge + column % kBrickEdge;
  return static_cast<std::size_t>(y * grid.size[0] + x) * static_cast<std::size_t>(mask_bytes) +
         static_cast<std::size_t>(brick[2] - grid.origin[2] / kBrickEdge);
}

/// For each half of a listed brick, a lane for each of its 32 columns: brings their voxels and their bytes of
/// the masks up to date.
struct UpdateBricks {
  const FuseTick* tick;
  const std::uint32_t* listed;
  DenseBricks bricks;
  std::uint8_t* occupied;  ///< The masks of FusedView, as bytes.
  std::uint8_t* free;
  std::int32_t mask_bytes;  ///< Of a column.
  std::uint32_t min_hits;

  static constexpr std::int32_t kPerBrick = kBrickColumns / kLanes;

  __device__ void operator()(std::int32_t i) const {
    const Int3 brick = world_brick(tick->grid, static_cast<std::int32_t>(listed[i / kPerBrick]));
    const std::int32_t first = i % kPerBrick * kLanes;
    const std::size_t begin = bricks.begin_of(brick) + static_cast<std::size_t>(first) * kBrickEdge;
    const auto cells_of = [&](std::int32_t lane) {
      return begin + static_cast<std::size_t>(lane) * kBrickEdge;
    };
    PerLane<CellColumn> cells;
    if (tick->enters(brick)) {
      sum_window(brick, first, cells);
    } else {
      for_each_lane([&](std::int32_t lane) {
        cells[lane].read(bricks, cells_of(lane));
        cells[lane].hide(bricks, cells_of(lane), bricks.shown_in(cells_of(lane)));
      });
      change(brick, first, begin, cells);
    }
    for_each_lane([&](std::int32_t lane) {
      cells[lane].write(bricks, cells_of(lane));
      const std::size_t byte = mask_byte(tick->grid, brick, first + lane, mask_bytes);
      occupied[byte] = cells[lane].occupied(min_hits);
      free[byte] = cells[lane].free(min_hits);
    });
  }

 private:
  /// Calls `visit(lane, a map's brick, the lookup values of its column)` for those of the maps that have the
  /// brick.
  template <class Visit>
  __device__ void for_each_column(std::int32_t from, std::int32_t count, const Int3& brick,
                                  std::int32_t first, Visit&& visit) const {
    for_each_holders(*tick, from, count, brick, [&](const Holders& holders) {
      holders.for_each([&](const MapBrick& one) {
        for_each_lane([&](std::int32_t lane) { visit(lane, one, one.column(first + lane)); });
      });
    });
  }

  __device__ void sum_window(const Int3& brick, std::int32_t first, PerLane<CellColumn>& cells) const {
    for_each_lane([&](std::int32_t lane) { cells[lane].clear(); });
    const auto add = [&](std::int32_t lane, const MapBrick& one, const Eight<std::int32_t>& lookup) {
      cells[lane].add(one, lookup);
    };
    for_each_column(0, tick->window_maps, brick, first, add);
  }

  // Minima are read only where a record comes or leaves.
  __device__ void change(const Int3& brick, std::int32_t first, std::size_t begin,
                         PerLane<CellColumn>& cells) const {
    const auto read_minima = [&](std::int32_t lane, const Eight<std::int32_t>& lookup) {
      if (has_record(lookup))
        cells[lane].read_minima(bricks, begin + static_cast<std::size_t>(lane) * kBrickEdge);
    };
    const auto add = [&](std::int32_t lane, const MapBrick& one, const Eight<std::int32_t>& lookup) {
      read_minima(lane, lookup);
      cells[lane].add(one, lookup);
    };
    const auto subtract = [&](std::int32_t lane, const MapBrick& one, const Eight<std::int32_t>& lookup) {
      read_minima(lane, lookup);
      cells[lane].subtract(one, lookup);
    };
    for_each_column(tick->added, 1, brick, first, add);
    for_each_column(tick->window_maps, tick->left_maps, brick, first, subtract);
    restore_minima(brick, first, cells);
  }

  // Looks minima that left up in the window, all its maps at once: few columns of a brick have one in a tick.
  __device__ void restore_minima(const Int3& brick, std::int32_t first, PerLane<CellColumn>& cells) const {
    PerLane<std::uint32_t> stale;
    for_each_lane([&](std::int32_t lane) { stale[lane] = cells[lane].forget_stale_minima(); });
    const std::uint32_t lanes = vote([&](std::int32_t lane) { return stale[lane] != 0; });
    if (lanes == 0) return;
    for_each_holders(*tick, 0, tick->window_maps, brick, [&](const Holders& holders) {
      for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
        const std::int32_t lane = lowest_lane(left);
        const Eight<float> min_m = holders.minima(first + lane, of_lane(stale, lane));
        in_lane(lane, [&] { cells[lane].lower_minima(min_m); });
      }
    });
  }
};

/// For each stack of the grid's bricks: when each of its 64 columns was last observed (R15). A lane for each
/// map of the window; its word of the stack is summed when the map comes, when the stack enters the grid, and
/// when the grid moves up or down.
struct UpdateLastSeen {
  const FuseTick* tick;
  std::int64_t* last_seen_ns;  ///< As in FusedView.
  std::int32_t n_xy;

  __device__ void operator()(std::int32_t stack) const {
    const Int3 lowest = world_brick(tick->grid, stack);
    PerLane<Newest> newest;
    for (std::int32_t first = 0; first < tick->window_maps; first += kLanes) {
      PerLane<std::uint64_t> word;
      for_each_lane([&](std::int32_t lane) {
        word[lane] = first + lane < tick->window_maps ? observed(first + lane, lowest) : 0;
      });
      for (std::int32_t column = 0; column < kBrickColumns; ++column) {
        const std::uint32_t seen = vote([&](std::int32_t lane) { return (word[lane] >> column & 1) != 0; });
        in_lane(column % kLanes, [&] { newest[column % kLanes].take(column / kLanes, first, seen); });
      }
    }
    for_each_lane([&](std::int32_t lane) {
      GVOM_UNROLL
      for (std::int32_t half = 0; half < Newest::kHalves; ++half)
        last_seen_ns[place(lowest, lane + half * kLanes)] = stamp_of(newest[lane].map[half]);
    });
  }

 private:
  /// For the columns `lane` and `lane + 32`: the index, plus one, of the newest map that observed it; else 0.
  struct Newest {
    static constexpr std::int32_t kHalves = kBrickColumns / kLanes;
    std::int32_t map[kHalves] = {};

    __device__ void take(std::int32_t half, std::int32_t first, std::uint32_t seen) {
      GVOM_UNROLL
      for (std::int32_t h = 0; h < kHalves; ++h)  // a constant index stays in a register
        if (h == half && map[h] == 0 && seen != 0) map[h] = first + lowest_lane(seen) + 1;
    }
  };

  /// A map's word of the stack that starts in the brick `lowest`.
  __device__ std::uint64_t observed(std::int32_t m, const Int3& lowest) const {
    const DeviceMap& map = tick->map(m);
    const std::int32_t stack =
        map.grid.slot_of_brick({lowest[0], lowest[1], map.grid.origin[2] / kBrickEdge});
    if (stack < 0) return 0;
    if (m == tick->added || tick->moved_in_z || tick->enters(lowest)) map.observed[stack] = sum(map, lowest);
    return map.observed[stack];
  }

  /// In batches of eight: the looks of a batch do not wait for each other.
  __device__ std::uint64_t sum(const DeviceMap& map, const Int3& lowest) const {
    const std::int32_t n_z = tick->grid.bricks()[2];
    std::uint64_t columns = 0;
    for (std::int32_t first = 0; first < n_z; first += kBrickEdge) {
      std::int32_t brick[kBrickEdge];
      GVOM_UNROLL
      for (std::int32_t k = 0; k < kBrickEdge; ++k)
        brick[k] = first + k < n_z ? map.brick_at({lowest[0], lowest[1], lowest[2] + first + k}) : -1;
      GVOM_UNROLL
      for (std::int32_t k = 0; k < kBrickEdge; ++k) columns |= brick[k] >= 0 ? map.columns[brick[k]] : 0;
    }
    return columns;
  }

  __device__ std::int32_t place(const Int3& lowest, std::int32_t column) const {
    const std::int32_t x = wrap(lowest[0] * kBrickEdge + column / kBrickEdge, n_xy);
    const std::int32_t y = wrap(lowest[1] * kBrickEdge + column % kBrickEdge, n_xy);
    return y * n_xy + x;
  }

  __device__ std::int64_t stamp_of(std::int32_t map_and_one) const {
    return map_and_one == 0 ? kNeverSeen : tick->map(map_and_one - 1).stamp_ns;
  }
};

}  // namespace gvom::cuda
