// When each column was last observed (R15), and how low rays have been in it (R5a).
#include <algorithm>

#include "core/cpu/fused_map.hpp"

namespace gvom::cpu {

namespace {

// Of the 64 columns of a stack of bricks, or nullptr where the map does not reach.
const float* lowest_rays(const BrickMapView& map, std::int32_t bx, std::int32_t by) {
  const std::int32_t stack = map.grid.stack_of_brick(bx, by);
  return stack < 0 ? nullptr : map.lowest_ray_m + std::ptrdiff_t{stack} * kBrickColumns;
}

}  // namespace

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

void FusedMap::update_lowest_ray(std::int32_t bx, std::int32_t by, const Change& change, bool all) {
  float* const lowest_m = lowest_ray_m_.data() + stack_of(bx, by);
  if (all) return refresh_lowest_ray(bx, by, ~std::uint64_t{0}, lowest_m);
  const float* const added_m = lowest_rays(change.added->view, bx, by);
  for (int c = 0; added_m != nullptr && c < kBrickColumns; ++c) lowest_m[c] = lower(lowest_m[c], added_m[c]);
  std::uint64_t stale = 0;
  for (const WindowMap& left : *change.left) {
    const float* const left_m = lowest_rays(left.view, bx, by);
    for (int c = 0; left_m != nullptr && c < kBrickColumns; ++c)
      stale |= std::uint64_t{left_m[c] == lowest_m[c] && left_m[c] < kNoRay_m} << c;
  }
  if (stale != 0) refresh_lowest_ray(bx, by, stale, lowest_m);
}

void FusedMap::refresh_lowest_ray(std::int32_t bx, std::int32_t by, std::uint64_t columns, float* lowest_m) {
  for (std::uint64_t rest = columns; rest != 0; rest &= rest - 1) lowest_m[__builtin_ctzll(rest)] = kNoRay_m;
  for (const WindowMap& map : window_.maps()) {
    const float* const map_m = lowest_rays(map.view, bx, by);
    for (std::uint64_t rest = map_m != nullptr ? columns : 0; rest != 0; rest &= rest - 1) {
      const int c = __builtin_ctzll(rest);
      lowest_m[c] = lower(lowest_m[c], map_m[c]);
    }
  }
}

}  // namespace gvom::cpu
