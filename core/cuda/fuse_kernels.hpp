// What a tick does to the fused map, brick by brick and column by column (R7, R8, R15).
#pragma once

#include "core/cell.hpp"
#include "core/cuda/atomics.hpp"
#include "core/cuda/device_map.hpp"

namespace gvom::cuda {

/// What changes when a map comes. Behind it in memory lie the maps of the window, newest first, then those
/// that left.
struct FuseTick {
  Grid grid;    ///< Now: that of the newest map (R7).
  Grid before;  ///< Of size 0 if nothing was there.
  std::int32_t added;
  std::int32_t window_maps;
  std::int32_t left_maps;
  bool moved_in_z;

  [[nodiscard]] GVOM_HD const DeviceMap& map(std::int32_t i) const {
    return reinterpret_cast<const DeviceMap*>(this + 1)[i];
  }
  [[nodiscard]] GVOM_HD const DeviceMap& left(std::int32_t i) const { return map(window_maps + i); }
  [[nodiscard]] GVOM_HD bool enters(const Int3& world_brick) const {
    return before.slot_of_brick(world_brick) < 0;
  }
};
static_assert(sizeof(FuseTick) % alignof(DeviceMap) == 0);

/// For each slot of the grid: lists it if the tick changes its brick.
struct ListChangedBricks {
  const FuseTick* tick;
  std::uint32_t* listed;  ///< Slots, in no order.
  std::uint32_t* count;

  GVOM_HD void operator()(std::int32_t slot) const {
    const Int3 brick = world_brick(tick->grid, slot);
    bool changed = tick->moved_in_z || tick->enters(brick) || tick->map(tick->added).brick_at(brick) >= 0;
    for (std::int32_t i = 0; i < tick->left_maps && !changed; ++i)
      changed = tick->left(i).brick_at(brick) >= 0;
    if (changed) listed[take_one(count)] = static_cast<std::uint32_t>(slot);
  }
};

/// Eight fused voxels above each other: a column within a brick.
class CellColumn {
 public:
  GVOM_HD CellColumn(const DenseBricks& bricks, std::size_t begin, bool empty) {
    if (empty) {
      for (int z = 0; z < kBrickEdge; ++z) hits_.at[z] = 0, passes_.at[z] = 0, min_m_.at[z] = kNoHeight_m;
    } else {
      hits_ = read_eight(bricks.hits + begin);
      passes_ = read_eight(bricks.passes + begin);
      min_m_ = read_eight(bricks.min_height_m + begin);
    }
  }

  GVOM_HD void write(const DenseBricks& bricks, std::size_t begin) const {
    write_eight(bricks.hits + begin, hits_);
    write_eight(bricks.passes + begin, passes_);
    write_eight(bricks.min_height_m + begin, min_m_);
  }

  GVOM_HD void add(const DeviceMap& map, const Int3& brick, std::int32_t column) {
    for_each_cell(map, brick, column, [this, &map](int z, std::int32_t lookup) {
      passes_.at[z] += free_passes(lookup);
      if (lookup >= 0) add_record(map.records[lookup], cell(z));
    });
  }

  GVOM_HD void subtract(const DeviceMap& map, const Int3& brick, std::int32_t column) {
    for_each_cell(map, brick, column, [this, &map](int z, std::int32_t lookup) {
      passes_.at[z] -= free_passes(lookup);
      if (lookup >= 0 && subtract_record(map.records[lookup], cell(z))) stale_ |= 1u << z;
    });
  }

  /// Looks minima that left up in the window, until all maps that hit a voxel were seen or none can be lower.
  GVOM_HD void restore_minima(const FuseTick& tick, const Int3& brick, std::int32_t column) {
    Eight<std::uint32_t> unseen_hits = hits_;
    const Eight<float> least_m = min_m_;
    for (int z = 0; z < kBrickEdge; ++z) {
      if (hits_.at[z] == 0) stale_ &= ~(1u << z);
      if (stale_ >> z & 1) min_m_.at[z] = kNoHeight_m;
    }
    for (std::int32_t i = 0; i < tick.window_maps && stale_ != 0; ++i) {
      const DeviceMap& map = tick.map(i);
      for_each_cell(map, brick, column, [&](int z, std::int32_t lookup) {
        if (lookup < 0 || (stale_ >> z & 1) == 0) return;
        const VoxelRecord& record = map.records[lookup];
        min_m_.at[z] = lower(min_m_.at[z], record.min_height_m);
        unseen_hits.at[z] -= record.hits;
        if (unseen_hits.at[z] == 0 || min_m_.at[z] == least_m.at[z]) stale_ &= ~(1u << z);
      });
    }
  }

  /// Bit z: occupied, free (R8).
  [[nodiscard]] GVOM_HD std::uint8_t occupied(std::uint32_t min_hits) const {
    unsigned bits = 0;
    for (int z = 0; z < kBrickEdge; ++z)
      bits |= static_cast<unsigned>(is_occupied(hits_.at[z], min_hits)) << z;
    return static_cast<std::uint8_t>(bits);
  }
  [[nodiscard]] GVOM_HD std::uint8_t free(std::uint32_t min_hits) const {
    unsigned bits = 0;
    for (int z = 0; z < kBrickEdge; ++z)
      bits |= static_cast<unsigned>(is_free(hits_.at[z], passes_.at[z], min_hits)) << z;
    return static_cast<std::uint8_t>(bits);
  }

 private:
  /// Calls `visit(z, lookup)` for the map's eight voxels, if it has the brick.
  template <class Visit>
  GVOM_HD static void for_each_cell(const DeviceMap& map, const Int3& brick, std::int32_t column,
                                    Visit&& visit) {
    const std::int32_t index = map.brick_at(brick);
    if (index < 0) return;
    const Eight<std::int32_t> lookup =
        read_eight(map.lookup + static_cast<std::size_t>(index) * kBrickCells + column * kBrickEdge);
    for (int z = 0; z < kBrickEdge; ++z) visit(z, lookup.at[z]);
  }
  GVOM_HD FusedCell cell(int z) { return {hits_.at[z], passes_.at[z], min_m_.at[z]}; }

  Eight<std::uint32_t> hits_;
  Eight<std::uint32_t> passes_;
  Eight<float> min_m_;
  std::uint32_t stale_ = 0;
};

/// For each of the 64 columns of each listed brick: brings its voxels and its byte of the masks up to date.
struct UpdateBricks {
  const FuseTick* tick;
  const std::uint32_t* listed;
  DenseBricks bricks;
  std::uint8_t* occupied;  ///< The masks of FusedView, as bytes.
  std::uint8_t* free;
  std::int32_t mask_bytes;  ///< Of a column.
  std::uint32_t min_hits;

  GVOM_HD void operator()(std::int32_t i) const {
    const Int3 brick = world_brick(tick->grid, static_cast<std::int32_t>(listed[i / 64]));
    const std::int32_t column = i % 64;
    const std::size_t begin = bricks.begin_of(brick) + static_cast<std::size_t>(column * kBrickEdge);
    const bool enters = tick->enters(brick);
    CellColumn cells(bricks, begin, enters);
    if (enters) {
      for (std::int32_t m = 0; m < tick->window_maps; ++m) cells.add(tick->map(m), brick, column);
    } else {
      cells.add(tick->map(tick->added), brick, column);
      for (std::int32_t m = 0; m < tick->left_maps; ++m) cells.subtract(tick->left(m), brick, column);
      cells.restore_minima(*tick, brick, column);
    }
    cells.write(bricks, begin);
    const std::size_t byte = mask_byte(brick, column);
    occupied[byte] = cells.occupied(min_hits);
    free[byte] = cells.free(min_hits);
  }

 private:
  // Little-endian, as all machines with CUDA are.
  GVOM_HD std::size_t mask_byte(const Int3& brick, std::int32_t column) const {
    const std::int32_t n_xy = bricks.bricks[0] * kBrickEdge;
    const std::int32_t x = wrap(brick[0], bricks.bricks[0]) * kBrickEdge + column / kBrickEdge;
    const std::int32_t y = wrap(brick[1], bricks.bricks[1]) * kBrickEdge + column % kBrickEdge;
    return static_cast<std::size_t>(y * n_xy + x) * static_cast<std::size_t>(mask_bytes) +
           static_cast<std::size_t>(brick[2] - tick->grid.origin[2] / kBrickEdge);
  }
};

/// For each column of the grid: when it was last observed (R15).
struct UpdateLastSeen {
  const FuseTick* tick;
  std::int64_t* last_seen_ns;  ///< As in FusedView.
  std::int32_t n_xy;

  GVOM_HD void operator()(std::int32_t i) const {
    const Int3& origin = tick->grid.origin;
    const std::int32_t x = origin[0] + i % n_xy, y = origin[1] + i / n_xy;
    const Int3 lowest{floor_to_brick(x) / kBrickEdge, floor_to_brick(y) / kBrickEdge, origin[2] / kBrickEdge};
    const int bit = (x & 7) * kBrickEdge + (y & 7);
    std::int64_t& place = last_seen_ns[wrap(y, n_xy) * n_xy + wrap(x, n_xy)];
    std::int64_t last_ns = place;
    if (tick->moved_in_z || tick->enters(lowest)) {
      last_ns = newest(lowest, bit, INT64_MAX);
    } else {
      const DeviceMap& added = tick->map(tick->added);
      if (added.stamp_ns > last_ns && observes(added, lowest, bit)) last_ns = added.stamp_ns;
      for (std::int32_t m = 0; m < tick->left_maps; ++m)
        if (tick->left(m).stamp_ns == last_ns) last_ns = newest(lowest, bit, last_ns);
    }
    place = last_ns;
  }

 private:
  /// Whether a map observed a voxel of the column that starts in the brick `lowest`.
  GVOM_HD bool observes(const DeviceMap& map, const Int3& lowest, int bit) const {
    const std::int32_t n_z = tick->grid.bricks()[2];
    for (std::int32_t z = 0; z < n_z; ++z) {
      const std::int32_t brick = map.brick_at({lowest[0], lowest[1], lowest[2] + z});
      if (brick >= 0 && (map.columns[brick] >> bit & 1) != 0) return true;
    }
    return false;
  }

  /// The newest stamp of the window up to `most_ns` whose map observed the column.
  GVOM_HD std::int64_t newest(const Int3& lowest, int bit, std::int64_t most_ns) const {
    for (std::int32_t m = 0; m < tick->window_maps; ++m) {
      const DeviceMap& map = tick->map(m);
      if (map.stamp_ns <= most_ns && observes(map, lowest, bit)) return map.stamp_ns;
    }
    return kNeverSeen;
  }
};

}  // namespace gvom::cuda
