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

// Forgets what is older than `most` beats, a number with its beat in the low byte or 0; the oldest age of the
// rest, or -1.
GVOM_CLONES std::int32_t forget_old(std::uint8_t now, std::int16_t most, std::uint16_t* cells) {
  std::int16_t oldest = -1;
  for (int i = 0; i < kBrickCells; ++i) {
    const auto age = static_cast<std::int16_t>((now - cells[i]) & 0xFF);
    const bool keeps = (static_cast<int>(cells[i] != 0) & static_cast<int>(age <= most)) != 0;
    cells[i] = keeps ? cells[i] : std::uint16_t{0};
    const std::int16_t kept_age = keeps ? age : std::int16_t{-1};
    oldest = kept_age > oldest ? kept_age : oldest;
  }
  return oldest;
}

// Of a map's brick: which passes tell something; its voxels are added to those of lower bricks.
GVOM_CLONES void find_silent(const CellBits& hit, const CellBits& passed, CellBits& lower, CellBits& silent) {
  GVOM_INDEPENDENT
  for (std::size_t c = 0; c < silent.size(); ++c) {
    silent[c] = static_cast<std::uint8_t>(passed[c] & ~telling_passes(hit[c], passed[c], lower[c] != 0));
    lower[c] = static_cast<std::uint8_t>(lower[c] | hit[c] | passed[c]);
  }
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

}  // namespace

Memory::Memory(const Grid& grid, const MemoryConfig& config, std::size_t most_maps)
    : beats_(beats_remembered(config.max_age_s)) {
  if (!on()) return;
  left_.reserve(most_maps);
  const std::size_t bricks = grid.brick_slots();
  bricks_.resize(bricks);
  hit_.resize(bricks);
  hits_.resize(bricks * kBrickCells, kNoHits);
  hit_beats_.resize(bricks * kBrickCells);
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
    left_.push_back({&left.view, static_cast<std::uint8_t>(beat), now_ - beat > beats_, span_m, {}});
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
    std::uint64_t columns = 0, lower = 0;
    for (std::int32_t bz = low; bz < low + grid.bricks()[2]; ++bz) {
      const std::int32_t brick = left.map->brick_at({bx, by, bz});
      if (brick < 0) continue;
      columns |= left.map->columns[brick];
      if (bz < low_) lower |= left.map->columns[brick];
    }
    left.lower = {};
    for (; lower != 0; lower &= lower - 1) left.lower[static_cast<std::size_t>(__builtin_ctzll(lower))] = 1;
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
  hit_[slot] = {};
  std::fill_n(hit_beats_.data() + begin, kBrickCells, std::uint16_t{0});
  std::fill_n(passes_.data() + begin, kBrickCells, RememberedPasses{0});
  brick = {};
}

bool Memory::expire(std::uint32_t slot, const BrickCells& cells) {
  Brick& brick = bricks_[slot];
  if (!brick.has_any || !is_too_old(brick.oldest)) return false;
  std::uint16_t* const hit_beats = hit_beats_.data() + std::size_t{slot} * kBrickCells;
  RememberedPasses* const passes = passes_.data() + std::size_t{slot} * kBrickCells;
  const auto kept = static_cast<std::int16_t>(all_too_old_ ? -1 : beats_);
  const std::int32_t oldest = std::max(forget_old(now(), kept, hit_beats), forget_old(now(), kept, passes));
  brick.has_any = oldest >= 0;
  brick.oldest = static_cast<std::uint8_t>(now_ - oldest);
  hit_[slot] = set_in(hit_beats);
  const CellBits taken = without(brick.shown, hit_[slot] | set_in(passes));
  take_back(brick, taken, cells);
  return any_of(taken);
}

void Memory::take_back(Brick& brick, const CellBits& taken, const BrickCells& cells) {
  brick.shown = without(brick.shown, taken);
  for_each_cell(taken, [&](std::size_t cell) {
    cells.hits[cell] = 0;
    cells.passes[cell] = 0;
    cells.min_height_m[cell] = kNoHeight_m;
  });
}

void Memory::note_beat(Brick& brick, std::uint8_t beat) {
  if (!brick.has_any || beats_between(brick.oldest, now()) < beats_between(beat, now())) brick.oldest = beat;
  brick.has_any = true;
}

void Memory::give_way(std::uint32_t slot, const ObservedBits& observed, const BrickCells& cells) {
  Brick& brick = bricks_[slot];
  take_back(brick, brick.shown & (observed.hit | observed.passed), cells);
}

void Memory::remember(std::uint32_t slot, std::size_t i, std::int32_t brick) {
  Left& left = left_[i];
  const std::int32_t* const lookup = left.map->lookup_of(brick);
  const ObservedBits observed = observed_in(lookup);
  left_cells_ = left_cells_ | observed.hit | observed.passed;
  CellBits silent;  // passes that say nothing
  find_silent(observed.hit, observed.passed, left.lower, silent);
  if (left.too_old) return;
  std::uint16_t passes[kBrickCells];
  read_passes(lookup, passes);
  for_each_cell(silent, [&](std::size_t cell) { passes[cell] = 0; });
  add_passes(passes, left.beat, now(), passes_.data() + std::size_t{slot} * kBrickCells);
  tell_hits(slot, left, lookup, observed.hit);
  note_beat(bricks_[slot], left.beat);
}

void Memory::tell_hits(std::uint32_t slot, const Left& left, const std::int32_t* lookup,
                       const CellBits& hit) {
  const std::size_t begin = std::size_t{slot} * kBrickCells;
  for_each_cell(hit, [&](std::size_t cell) {
    const RememberedHits had = has_bit(hit_[slot], cell) ? hits_[begin + cell] : kNoHits;
    const RememberedHits hits = with_record(had, left.map->records[lookup[cell]], left.beat, now());
    hits_[begin + cell] = hits;
    hit_beats_[begin + cell] = static_cast<std::uint16_t>(0x100 | hits.beat());
  });
  hit_[slot] = hit_[slot] | hit;
}

void Memory::show(std::uint32_t slot, std::uint32_t min_hits, const BrickCells& cells, VoxelBits& bits) {
  const std::size_t begin = std::size_t{slot} * kBrickCells;
  const CellBits unseen = without(left_cells_, bits.occupied | bits.free);
  left_cells_ = {};
  CellBits& shown = bricks_[slot].shown;
  for_each_cell(unseen & hit_[slot], [&](std::size_t cell) {
    const VoxelRecord voxel = shown_voxel(hits_[begin + cell], passes_[begin + cell], now());
    if ((voxel.hits | voxel.passes) == 0) return;
    cells.hits[cell] = voxel.hits;
    cells.passes[cell] = voxel.passes;
    cells.min_height_m[cell] = voxel.min_height_m;
    set_bit(shown, cell);
    const bool occupied = is_occupied(voxel.hits, min_hits);
    set_bit(occupied ? bits.occupied : bits.free, cell);
    if (occupied && !is_worn(voxel.hits, voxel.passes)) set_bit(bits.solid, cell);
  });
  for_each_cell(without(unseen, hit_[slot]), [&](std::size_t cell) {
    cells.passes[cell] = passes_in(passes_[begin + cell]);
    if (cells.passes[cell] == 0) return;
    set_bit(shown, cell);
    set_bit(bits.free, cell);
  });
}

void Memory::reset() {
  empty_ = true;
  std::fill(bricks_.begin(), bricks_.end(), Brick{});
  std::fill(hit_.begin(), hit_.end(), CellBits{});
  std::fill(hit_beats_.begin(), hit_beats_.end(), std::uint16_t{0});
  std::fill(passes_.begin(), passes_.end(), RememberedPasses{0});
  std::fill(spans_m_.begin(), spans_m_.end(), kNoRay_m);
  std::fill(lowest_ray_m_.begin(), lowest_ray_m_.end(), kNoRay_m);
}

}  // namespace gvom::cpu
