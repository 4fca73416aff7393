// When each column was last observed (R15), and the fused voxels as a brick map (R6).
#include <algorithm>

#include "core/cpu/fused_map.hpp"

namespace gvom::cpu {

std::uint64_t FusedMap::observed_columns(const BrickMapView& map, std::int32_t bx, std::int32_t by) const {
  std::uint64_t columns = 0;
  const std::int32_t low = grid_.origin[2] / kBrickEdge;
  for (std::int32_t bz = low; bz < low + grid_.bricks()[2]; ++bz) {
    const std::int32_t brick = map.brick_at({bx, by, bz});
    if (brick >= 0) columns |= map.columns[brick];
  }
  return columns;
}

void FusedMap::update_last_seen(std::int32_t bx, std::int32_t by, const Change& change, bool all) {
  if (all) return refresh_last_seen(bx, by, ~std::uint64_t{0}, INT64_MAX);
  const std::int64_t stamp_ns = change.added->view.stamp_ns;
  for (std::uint64_t seen = observed_columns(change.added->view, bx, by); seen != 0; seen &= seen - 1) {
    std::int64_t& last_ns = last_seen_ns_[column_of(bx, by, __builtin_ctzll(seen))];
    last_ns = std::max(last_ns, stamp_ns);
  }
  for (const WindowMap& left : *change.left) {
    std::uint64_t stale = 0;
    for (std::uint64_t seen = observed_columns(left.view, bx, by); seen != 0; seen &= seen - 1) {
      const int column = __builtin_ctzll(seen);
      if (last_seen_ns_[column_of(bx, by, column)] == left.view.stamp_ns) stale |= std::uint64_t{1} << column;
    }
    if (stale != 0) refresh_last_seen(bx, by, stale, left.view.stamp_ns);
  }
}

void FusedMap::refresh_last_seen(std::int32_t bx, std::int32_t by, std::uint64_t columns,
                                 std::int64_t newest_ns) {
  for (const WindowMap& map : window_.maps()) {  // newest first
    if (map.view.stamp_ns > newest_ns) continue;
    const std::uint64_t found = columns & observed_columns(map.view, bx, by);
    for (std::uint64_t rest = found; rest != 0; rest &= rest - 1)
      last_seen_ns_[column_of(bx, by, __builtin_ctzll(rest))] = map.view.stamp_ns;
    columns &= ~found;
    if (columns == 0) return;
  }
  for (; columns != 0; columns &= columns - 1)
    last_seen_ns_[column_of(bx, by, __builtin_ctzll(columns))] = kNeverSeen;
}

BrickMapShape FusedMap::shape() const {
  BrickMapShape shape{grid_.brick_slots(), 0, 0};
  for (std::uint32_t slot = 0; slot < shape.brick_slots; ++slot) {
    shape.brick_count += live_[slot];
    shape.record_count += hit_cells_[slot];
  }
  return shape;
}

void FusedMap::write(const BrickMapArrays& out) const {
  std::fill_n(out.directory, grid_.brick_slots(), -1);
  const Int3 n = grid_.bricks();
  std::int32_t brick = 0;
  std::int32_t record = 0;
  std::uint32_t slot = 0;
  for (std::int32_t bz = 0; bz < n[2]; ++bz)
    for (std::int32_t by = 0; by < n[1]; ++by)
      for (std::int32_t bx = 0; bx < n[0]; ++bx, ++slot) {
        const std::uint32_t place =
            slot_of({grid_.origin[0] / kBrickEdge + bx, grid_.origin[1] / kBrickEdge + by,
                     grid_.origin[2] / kBrickEdge + bz});
        if (!live_[place]) continue;
        std::uint64_t columns = 0;
        for (std::size_t cell = 0; cell < kBrickCells; ++cell) {
          const std::size_t i = std::size_t{place} * kBrickCells + cell;
          std::int32_t& lookup = out.lookup[static_cast<std::size_t>(brick) * kBrickCells + cell];
          if (hits_[i] + passes_[i] != 0) columns |= std::uint64_t{1} << (cell >> 3);
          lookup = hits_[i] > 0 ? record : free_lookup(passes_[i]);
          if (hits_[i] > 0) out.records[record++] = {hits_[i], passes_[i], min_height_m_[i]};
        }
        out.directory[slot] = brick;
        out.columns[brick++] = columns;
      }
}

}  // namespace gvom::cpu
