#include "core/cpu/memory.hpp"

#include <algorithm>

#include "core/cpu/clones.hpp"

namespace gvom::cpu {

namespace {

// Passes of the voxels without hits, no more than are remembered.
GVOM_CLONES void read_passes(const std::int32_t* lookup, std::uint16_t* passes) {
  for (int i = 0; i < kBrickCells; ++i) passes[i] = rememberable(free_passes(lookup[i]));
}

GVOM_CLONES void add_passes(const std::uint16_t* passes, std::uint8_t second, std::uint8_t now,
                            RememberedPasses* cells) {
  GVOM_INDEPENDENT
  for (int i = 0; i < kBrickCells; ++i) cells[i] = with_passes(cells[i], passes[i], second, now);
}

GVOM_CLONES void age_no_further(std::uint8_t now, std::uint8_t most, std::size_t n, std::uint8_t* seconds) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint8_t age = seconds_between(seconds[i], now);
    seconds[i] = static_cast<std::uint8_t>(now - (age < most ? age : most));
  }
}

GVOM_CLONES void lower_stack(const float* from_m, float doubt_m, float* to_m) {
  GVOM_INDEPENDENT
  for (int c = 0; c < kBrickColumns; ++c) to_m[c] = lower(to_m[c], from_m[c] + doubt_m);
}

GVOM_CLONES void lower_all(const float* from_m, std::size_t n, float* to_m) {
  GVOM_INDEPENDENT
  for (std::size_t i = 0; i < n; ++i) to_m[i] = lower(to_m[i], from_m[i]);
}

void clear_cell(std::size_t cell, const BrickCells& cells) {
  cells.hits[cell] = 0;
  cells.passes[cell] = 0;
  cells.min_height_m[cell] = kNoHeight_m;
}

}  // namespace

Memory::Memory(const Grid& grid, const MemoryConfig& config, std::size_t most_maps)
    : seconds_(seconds_remembered(config.max_age_s)) {
  if (!on()) return;
  left_.reserve(most_maps);
  const std::size_t bricks = grid.brick_slots();
  bricks_.resize(bricks);
  hits_.resize(bricks * kBrickCells, kNoHits);
  passes_.resize(bricks * kBrickCells);
  column_seconds_.resize(grid.columns());
  spans_m_.resize(kSpans * std::size_t{grid.columns()}, kNoRay_m);
  lowest_ray_m_.resize(grid.columns(), kNoRay_m);
}

float* Memory::span_of_rays(std::int64_t number) {
  const std::int64_t place = (number % kSpans + kSpans) % kSpans;
  return spans_m_.data() + static_cast<std::size_t>(place) * lowest_ray_m_.size();
}

void Memory::begin(const Window& window) {
  const BrickMapView& newest = window.maps().front().view;
  const std::int64_t before = empty_ ? second_of(newest.stamp_ns) : now_;
  now_ = second_of(newest.stamp_ns);
  low_ = newest.grid.origin[2] / kBrickEdge;
  all_too_old_ = now_ - before > seconds_;
  if (empty_ || now_ != before) forget_old_columns();
  const std::int64_t span = span_of(now_, seconds_);
  forget_old_spans(span_of(before, seconds_), span);
  empty_ = false;
  left_.clear();
  for (const WindowMap& left : window.left()) {
    const std::int64_t second = second_of(left.view.stamp_ns);
    const std::int64_t own_span = span_of(second, seconds_);
    float* const span_m = span - own_span < kSpans ? span_of_rays(own_span) : nullptr;
    left_.push_back({&left.view, static_cast<std::uint8_t>(second), now_ - second > seconds_, span_m, 0});
  }
}

void Memory::forget_old_columns() {
  if (empty_ || all_too_old_)
    std::fill(column_seconds_.begin(), column_seconds_.end(), too_old_second());
  else
    age_no_further(now(), static_cast<std::uint8_t>(seconds_ + 1), column_seconds_.size(),
                   column_seconds_.data());
}

void Memory::forget_old_spans(std::int64_t before, std::int64_t span) {
  if (span == before) return;
  const std::size_t columns = lowest_ray_m_.size();
  for (std::int64_t passed = std::max(before, span - kSpans) + 1; passed <= span; ++passed)
    std::fill_n(span_of_rays(passed), columns, kNoRay_m);
  std::fill(lowest_ray_m_.begin(), lowest_ray_m_.end(), kNoRay_m);
  for (std::int64_t kept = 0; kept < kSpans; ++kept)
    lower_all(span_of_rays(kept), columns, lowest_ray_m_.data());
}

void Memory::begin_stack(std::int32_t bx, std::int32_t by, std::size_t stack, bool enters) {
  if (enters) {
    std::fill_n(column_seconds_.data() + stack, kBrickColumns, too_old_second());
    std::fill_n(lowest_ray_m_.data() + stack, kBrickColumns, kNoRay_m);
    for (std::int64_t i = 0; i < kSpans; ++i) std::fill_n(span_of_rays(i) + stack, kBrickColumns, kNoRay_m);
  }
  for (Left& left : left_) {
    const Grid& grid = left.map->grid;
    const std::int32_t low = grid.origin[2] / kBrickEdge;
    std::uint64_t columns = 0;
    left.lower = 0;
    for (std::int32_t bz = low; bz < low + grid.bricks()[2]; ++bz) {
      const std::int32_t brick = left.map->brick_at({bx, by, bz});
      if (brick < 0) continue;
      columns |= left.map->columns[brick];
      if (bz < low_) left.lower |= left.map->columns[brick];
    }
    remember_seconds(left, columns, stack);
    const std::int32_t own_stack = grid.stack_of_brick(bx, by);
    if (own_stack < 0 || left.span_m == nullptr) continue;
    const float* const rays_m = left.map->lowest_ray_m + std::ptrdiff_t{own_stack} * kBrickColumns;
    const float doubt_m = doubt_of_rays_m(grid, bx, by);
    lower_stack(rays_m, doubt_m, left.span_m + stack);
    lower_stack(rays_m, doubt_m, lowest_ray_m_.data() + stack);
  }
}

void Memory::remember_seconds(const Left& left, std::uint64_t columns, std::size_t stack) {
  if (left.too_old) return;
  const std::uint8_t age = seconds_between(left.second, now());
  for (std::size_t c = 0; c < kBrickColumns; ++c) {
    std::uint8_t& second = column_seconds_[stack + c];
    const bool newer = (columns >> c & 1) != 0 && age < seconds_between(second, now());
    second = newer ? left.second : second;
  }
}

void Memory::forget(std::uint32_t slot) {
  Brick& brick = bricks_[slot];
  if (!brick.has_any) return;
  const std::size_t begin = std::size_t{slot} * kBrickCells;
  std::fill_n(hits_.data() + begin, kBrickCells, kNoHits);
  std::fill_n(passes_.data() + begin, kBrickCells, RememberedPasses{0});
  brick = {};
}

bool Memory::expire(std::uint32_t slot, const BrickCells& cells) {
  Brick& brick = bricks_[slot];
  if (!brick.has_any || !is_too_old(brick.oldest)) return false;
  RememberedHits* const hits = hits_.data() + std::size_t{slot} * kBrickCells;
  RememberedPasses* const passes = passes_.data() + std::size_t{slot} * kBrickCells;
  brick.has_any = false;
  for (std::size_t i = 0; i < kBrickCells; ++i) {
    if (hits[i].bits != 0 && is_too_old(hits[i].second())) hits[i] = kNoHits;
    if (passes[i] != 0 && is_too_old(second_in(passes[i]))) passes[i] = 0;
    if (hits[i].bits != 0) note_second(brick, hits[i].second());
    if (passes[i] != 0) note_second(brick, second_in(passes[i]));
  }
  bool any = false;
  for_each_cell(brick.shown, [&](std::size_t cell) {
    if (hits[cell].bits != 0 || passes[cell] != 0) return;
    clear_cell(cell, cells);
    brick.shown[cell / 8] &= static_cast<std::uint8_t>(~(1U << (cell % 8)));
    any = true;
  });
  return any;
}

void Memory::note_second(Brick& brick, std::uint8_t second) {
  if (!brick.has_any || seconds_between(brick.oldest, now()) < seconds_between(second, now()))
    brick.oldest = second;
  brick.has_any = true;
}

void Memory::give_way(std::uint32_t slot, const std::int32_t* lookup, const BrickCells& cells) {
  CellBits& shown = bricks_[slot].shown;
  if (!any_of(shown)) return;
  const CellBits hit = at_least(lookup, 0), not_passed = at_least(lookup, -1);
  CellBits taken;
  for (std::size_t c = 0; c < taken.size(); ++c) {
    taken[c] = static_cast<std::uint8_t>(shown[c] & (hit[c] | ~not_passed[c]));
    shown[c] = static_cast<std::uint8_t>(shown[c] & ~taken[c]);
  }
  for_each_cell(taken, [&](std::size_t cell) { clear_cell(cell, cells); });
}

void Memory::remember(std::uint32_t slot, std::size_t i, std::int32_t brick) {
  Left& left = left_[i];
  const BrickMapView& map = *left.map;
  const std::int32_t* const lookup = map.lookup_of(brick);
  const CellBits hit = at_least(lookup, 0), not_passed = at_least(lookup, -1);
  CellBits silent;  // passes that say nothing
  for (std::size_t c = 0; c < hit.size(); ++c) {
    const auto passed = static_cast<std::uint8_t>(~not_passed[c]);
    left_cells_[c] = static_cast<std::uint8_t>(left_cells_[c] | hit[c] | passed);
    silent[c] =
        static_cast<std::uint8_t>(passed & ~telling_passes(hit[c], passed, (left.lower >> c & 1) != 0));
  }
  left.lower |= map.columns[brick];
  if (left.too_old) return;
  std::uint16_t passes[kBrickCells];
  read_passes(lookup, passes);
  for_each_cell(silent, [&](std::size_t cell) { passes[cell] = 0; });
  const std::size_t begin = std::size_t{slot} * kBrickCells;
  add_passes(passes, left.second, now(), passes_.data() + begin);
  for_each_cell(hit, [&](std::size_t cell) {
    RememberedHits& hits = hits_[begin + cell];
    hits = with_record(hits, map.records[lookup[cell]], left.second, now());
  });
  note_second(bricks_[slot], left.second);
}

bool Memory::show(std::uint32_t slot, const CellBits& free, const CellBits& occupied,
                  const BrickCells& cells) {
  const std::size_t begin = std::size_t{slot} * kBrickCells;
  CellBits silent;
  for (std::size_t c = 0; c < silent.size(); ++c)
    silent[c] = static_cast<std::uint8_t>(left_cells_[c] & ~(free[c] | occupied[c]));
  left_cells_ = {};
  bool any = false;
  for_each_cell(silent, [&](std::size_t cell) {
    const VoxelRecord voxel = shown_voxel(hits_[begin + cell], passes_[begin + cell], now());
    if ((voxel.hits | voxel.passes) == 0) return;
    cells.hits[cell] = voxel.hits;
    cells.passes[cell] = voxel.passes;
    cells.min_height_m[cell] = voxel.min_height_m;
    bricks_[slot].shown[cell / 8] |= static_cast<std::uint8_t>(1U << (cell % 8));
    any = true;
  });
  return any;
}

void Memory::reset() {
  empty_ = true;
  std::fill(bricks_.begin(), bricks_.end(), Brick{});
  std::fill(hits_.begin(), hits_.end(), kNoHits);
  std::fill(passes_.begin(), passes_.end(), RememberedPasses{0});
  std::fill(spans_m_.begin(), spans_m_.end(), kNoRay_m);
  std::fill(lowest_ray_m_.begin(), lowest_ray_m_.end(), kNoRay_m);
}

}  // namespace gvom::cpu
