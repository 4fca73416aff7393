#include "core/cpu/memory.hpp"

#include <algorithm>

#include "core/cpu/clones.hpp"

namespace gvom::cpu {

namespace {

// Passes of the voxels without hits, no more than are remembered.
GVOM_CLONES void read_passes(const std::int32_t* lookup, std::uint16_t* passes) {
  for (int i = 0; i < kBrickCells; ++i) passes[i] = rememberable(free_passes(lookup[i]));
}

GVOM_CLONES void add_passes(const std::uint16_t* passes, std::uint8_t beat, std::uint8_t now,
                            RememberedPasses* cells) {
  GVOM_INDEPENDENT
  for (int i = 0; i < kBrickCells; ++i) cells[i] = with_passes(cells[i], passes[i], beat, now);
}

// Forgets what is older than `most` beats; the oldest age of the rest, or -1.
GVOM_CLONES std::int32_t forget_hits(std::uint8_t now, std::int32_t most, RememberedHits* cells) {
  std::int32_t oldest = -1;
  for (int i = 0; i < kBrickCells; ++i) {
    const std::int32_t age = beats_between(cells[i].beat(), now);
    const bool keeps = (static_cast<int>(cells[i].bits != 0) & static_cast<int>(age <= most)) != 0;
    cells[i].bits = keeps ? cells[i].bits : 0;
    const std::int32_t kept_age = keeps ? age : -1;
    oldest = kept_age > oldest ? kept_age : oldest;
  }
  return oldest;
}

GVOM_CLONES std::int32_t forget_passes(std::uint8_t now, std::int32_t most, RememberedPasses* cells) {
  std::int32_t oldest = -1;
  for (int i = 0; i < kBrickCells; ++i) {
    const std::int32_t age = beats_between(beat_in(cells[i]), now);
    const bool keeps = (static_cast<int>(cells[i] != 0) & static_cast<int>(age <= most)) != 0;
    cells[i] = keeps ? cells[i] : RememberedPasses{0};
    const std::int32_t kept_age = keeps ? age : -1;
    oldest = kept_age > oldest ? kept_age : oldest;
  }
  return oldest;
}

GVOM_CLONES void age_no_further(std::uint8_t now, std::uint8_t most, std::size_t n, std::uint8_t* beats) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint8_t age = beats_between(beats[i], now);
    beats[i] = static_cast<std::uint8_t>(now - (age < most ? age : most));
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
    : beats_(beats_remembered(config.max_age_s)) {
  if (!on()) return;
  left_.reserve(most_maps);
  const std::size_t bricks = grid.brick_slots();
  bricks_.resize(bricks);
  hits_.resize(bricks * kBrickCells, kNoHits);
  passes_.resize(bricks * kBrickCells);
  column_beats_.resize(grid.columns());
  spans_m_.resize(kSpans * std::size_t{grid.columns()}, kNoRay_m);
  lowest_ray_m_.resize(grid.columns(), kNoRay_m);
}

float* Memory::span_of_rays(std::int64_t number) {
  const std::int64_t place = (number % kSpans + kSpans) % kSpans;
  return spans_m_.data() + static_cast<std::size_t>(place) * lowest_ray_m_.size();
}

void Memory::begin(const Window& window) {
  const BrickMapView& newest = window.maps().front().view;
  const std::int64_t before = empty_ ? beat_of(newest.stamp_ns) : now_;
  now_ = beat_of(newest.stamp_ns);
  low_ = newest.grid.origin[2] / kBrickEdge;
  all_too_old_ = now_ - before > beats_;
  if (empty_ || now_ != before) forget_old_columns();
  const std::int64_t span = span_of(now_, beats_);
  forget_old_spans(span_of(before, beats_), span);
  empty_ = false;
  left_.clear();
  for (const WindowMap& left : window.left()) {
    const std::int64_t beat = beat_of(left.view.stamp_ns);
    const std::int64_t own_span = span_of(beat, beats_);
    float* const span_m = span - own_span < kSpans ? span_of_rays(own_span) : nullptr;
    left_.push_back({&left.view, static_cast<std::uint8_t>(beat), now_ - beat > beats_, span_m, 0});
  }
}

void Memory::forget_old_columns() {
  if (empty_ || all_too_old_)
    std::fill(column_beats_.begin(), column_beats_.end(), too_old_beat());
  else
    age_no_further(now(), static_cast<std::uint8_t>(beats_ + 1), column_beats_.size(), column_beats_.data());
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
    std::fill_n(column_beats_.data() + stack, kBrickColumns, too_old_beat());
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
    remember_beats(left, columns, stack);
    const std::int32_t own_stack = grid.stack_of_brick(bx, by);
    if (own_stack < 0 || left.span_m == nullptr) continue;
    const float* const rays_m = left.map->lowest_ray_m + std::ptrdiff_t{own_stack} * kBrickColumns;
    const float doubt_m = doubt_of_rays_m(grid, bx, by);
    lower_stack(rays_m, doubt_m, left.span_m + stack);
    lower_stack(rays_m, doubt_m, lowest_ray_m_.data() + stack);
  }
}

void Memory::remember_beats(const Left& left, std::uint64_t columns, std::size_t stack) {
  if (left.too_old) return;
  const std::uint8_t age = beats_between(left.beat, now());
  for (std::size_t c = 0; c < kBrickColumns; ++c) {
    std::uint8_t& beat = column_beats_[stack + c];
    const bool newer = (columns >> c & 1) != 0 && age < beats_between(beat, now());
    beat = newer ? left.beat : beat;
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
  const std::int32_t kept = all_too_old_ ? -1 : beats_;
  const std::int32_t oldest = std::max(forget_hits(now(), kept, hits), forget_passes(now(), kept, passes));
  brick.has_any = oldest >= 0;
  brick.oldest = static_cast<std::uint8_t>(now_ - oldest);
  bool any = false;
  for_each_cell(brick.shown, [&](std::size_t cell) {
    if (hits[cell].bits != 0 || passes[cell] != 0) return;
    clear_cell(cell, cells);
    brick.shown[cell / 8] &= static_cast<std::uint8_t>(~(1U << (cell % 8)));
    any = true;
  });
  return any;
}

void Memory::note_beat(Brick& brick, std::uint8_t beat) {
  if (!brick.has_any || beats_between(brick.oldest, now()) < beats_between(beat, now())) brick.oldest = beat;
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
  add_passes(passes, left.beat, now(), passes_.data() + begin);
  for_each_cell(hit, [&](std::size_t cell) {
    RememberedHits& hits = hits_[begin + cell];
    hits = with_record(hits, map.records[lookup[cell]], left.beat, now());
  });
  note_beat(bricks_[slot], left.beat);
}

void Memory::show(std::uint32_t slot, std::uint32_t min_hits, const BrickCells& cells, VoxelBits& bits) {
  const std::size_t begin = std::size_t{slot} * kBrickCells;
  CellBits silent;
  for (std::size_t c = 0; c < silent.size(); ++c)
    silent[c] = static_cast<std::uint8_t>(left_cells_[c] & ~(bits.free[c] | bits.occupied[c]));
  left_cells_ = {};
  for_each_cell(silent, [&](std::size_t cell) {
    const VoxelRecord voxel = shown_voxel(hits_[begin + cell], passes_[begin + cell], now());
    if ((voxel.hits | voxel.passes) == 0) return;
    cells.hits[cell] = voxel.hits;
    cells.passes[cell] = voxel.passes;
    cells.min_height_m[cell] = voxel.min_height_m;
    const auto bit = static_cast<std::uint8_t>(1U << (cell % 8));
    bricks_[slot].shown[cell / 8] |= bit;
    (is_occupied(voxel.hits, min_hits) ? bits.occupied : bits.free)[cell / 8] |= bit;
  });
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
