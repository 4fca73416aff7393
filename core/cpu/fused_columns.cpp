// When each column was last observed (R15), and how low rays have been in it (R5a).
#include <algorithm>
#include <cstring>

#include "core/cpu/clones.hpp"
#include "core/cpu/fused_map.hpp"

namespace gvom::cpu {

namespace {

// Of the 64 columns of a stack of bricks, or nullptr where the map does not reach.
const float* lowest_rays(const BrickMapView& map, std::int32_t bx, std::int32_t by) {
  const std::int32_t stack = map.grid.stack_of_brick(bx, by);
  return stack < 0 ? nullptr : map.lowest_ray_m + std::ptrdiff_t{stack} * kBrickColumns;
}

GVOM_CLONES void lower_rays(const float* from_m, float* to_m) {
  GVOM_INDEPENDENT
  for (int c = 0; c < kBrickColumns; ++c) to_m[c] = lower(to_m[c], from_m[c]);
}

GVOM_CLONES void mark_held(const float* left_m, const float* lowest_m, std::uint8_t* held) {
  GVOM_INDEPENDENT
  for (int c = 0; c < kBrickColumns; ++c)
    held[c] = static_cast<std::uint8_t>(static_cast<int>(left_m[c] == lowest_m[c]) &
                                        static_cast<int>(left_m[c] < kNoRay_m));
}

// Bit c: byte c, which is 0 or 1.
std::uint64_t bits_of(const std::uint8_t* bytes) {
  std::uint64_t bits = 0;
  for (int i = 0; i < 8; ++i) {
    std::uint64_t eight;
    std::memcpy(&eight, bytes + 8 * i, sizeof eight);
    bits |= (eight * 0x0102040810204080U >> 56) << (8 * i);
  }
  return bits;
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

void FusedMap::update_last_seen(const Stack& stack, const Change& change, bool all) {
  if (all) return refresh_last_seen(stack, ~std::uint64_t{0}, INT64_MAX);
  const std::int64_t stamp_ns = change.added->view.stamp_ns;
  for (std::uint64_t seen = observed_columns(change.added->view, stack.bx, stack.by); seen != 0;
       seen &= seen - 1) {
    std::int64_t& last_ns = last_seen_ns_[stack.column(__builtin_ctzll(seen), grid_.size[0])];
    last_ns = std::max(last_ns, stamp_ns);
  }
  for (const WindowMap& left : *change.left) {
    std::uint64_t stale = 0;
    for (std::uint64_t seen = observed_columns(left.view, stack.bx, stack.by); seen != 0; seen &= seen - 1) {
      const int column = __builtin_ctzll(seen);
      if (last_seen_ns_[stack.column(column, grid_.size[0])] == left.view.stamp_ns)
        stale |= std::uint64_t{1} << column;
    }
    if (stale != 0) refresh_last_seen(stack, stale, left.view.stamp_ns);
  }
}

void FusedMap::refresh_last_seen(const Stack& stack, std::uint64_t columns, std::int64_t newest_ns) {
  for (const WindowMap& map : window_.maps()) {  // newest first
    if (map.view.stamp_ns > newest_ns) continue;
    const std::uint64_t found = columns & observed_columns(map.view, stack.bx, stack.by);
    for (std::uint64_t rest = found; rest != 0; rest &= rest - 1)
      last_seen_ns_[stack.column(__builtin_ctzll(rest), grid_.size[0])] = map.view.stamp_ns;
    columns &= ~found;
    if (columns == 0) return;
  }
  for (; columns != 0; columns &= columns - 1)
    last_seen_ns_[stack.column(__builtin_ctzll(columns), grid_.size[0])] = kNeverSeen;
}

void FusedMap::update_lowest_ray(const Stack& stack, const Change& change, bool all) {
  float* const lowest_m = lowest_ray_m_.data() + stack.rays;
  if (all) return refresh_lowest_ray(stack, ~std::uint64_t{0}, lowest_m);
  const float* const added_m = lowest_rays(change.added->view, stack.bx, stack.by);
  if (added_m != nullptr) lower_rays(added_m, lowest_m);
  std::uint64_t stale = 0;
  for (const WindowMap& left : *change.left) {
    const float* const left_m = lowest_rays(left.view, stack.bx, stack.by);
    if (left_m == nullptr) continue;
    std::uint8_t held[kBrickColumns];
    mark_held(left_m, lowest_m, held);
    stale |= bits_of(held);
  }
  if (stale != 0) refresh_lowest_ray(stack, stale, lowest_m);
}

void FusedMap::refresh_lowest_ray(const Stack& stack, std::uint64_t columns, float* lowest_m) {
  for (std::uint64_t rest = columns; rest != 0; rest &= rest - 1) lowest_m[__builtin_ctzll(rest)] = kNoRay_m;
  for (const WindowMap& map : window_.maps()) {
    const float* const map_m = lowest_rays(map.view, stack.bx, stack.by);
    for (std::uint64_t rest = map_m != nullptr ? columns : 0; rest != 0; rest &= rest - 1) {
      const int c = __builtin_ctzll(rest);
      lowest_m[c] = lower(lowest_m[c], map_m[c]);
    }
  }
}

}  // namespace gvom::cpu
