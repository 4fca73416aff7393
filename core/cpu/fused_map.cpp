#include "core/cpu/fused_map.hpp"

#include <algorithm>

#include "core/cpu/cell_bits.hpp"

namespace gvom::cpu {

namespace {

Grid empty_grid(const MapConfig& map) {
  return grid_around(map, Eigen::Vector3d::Zero());
}

std::int32_t brick_origin(const Grid& grid, int axis) {
  return grid.origin[static_cast<std::size_t>(axis)] / kBrickEdge;
}

}  // namespace

FusedMap::FusedMap(const MapperConfig& config)
    : window_(config.window, empty_grid(config.map)),
      grid_(empty_grid(config.map)),
      min_hits_(config.layers.min_hits),
      words_((config.map.size_z + 63) / 64),
      memory_(grid_, config.memory, window_.most_maps()) {
  const std::size_t bricks = grid_.brick_slots();
  const std::size_t columns = grid_.columns();
  hits_.resize(bricks * kBrickCells);
  passes_.resize(bricks * kBrickCells);
  min_height_m_.resize(bricks * kBrickCells, kNoHeight_m);
  live_.resize(bricks);
  hit_cells_.resize(bricks);
  occupied_.resize(columns * static_cast<std::size_t>(words_));
  free_.resize(columns * static_cast<std::size_t>(words_));
  if (memory_.on()) remembered_.resize(columns * static_cast<std::size_t>(words_));
  last_seen_ns_.resize(columns, kNeverSeen);
  lowest_ray_m_.resize(columns, kNoRay_m);
  stale_.reserve(kBrickCells);
}

FusedView FusedMap::view() const {
  return {grid_.size[0],
          grid_.size[2],
          words_,
          toroidal_origin(grid_),
          hits_.data(),
          passes_.data(),
          min_height_m_.data(),
          occupied_.data(),
          free_.data(),
          last_seen_ns_.data(),
          lowest_ray_m_.data(),
          memory_.on() ? memory_.view(remembered_.data()) : MemoryView{}};
}

std::uint32_t FusedMap::slot_of(const Int3& b) const {
  const Int3 n = grid_.bricks();
  return brick_slot(wrap(b[0], n[0]), wrap(b[1], n[1]), wrap(b[2], n[2]), n[0], n[1]);
}

std::size_t FusedMap::stack_of(std::int32_t bx, std::int32_t by) const {
  const Int3 n = grid_.bricks();
  return brick_slot(wrap(bx, n[0]), wrap(by, n[1]), 0, n[0], n[1]) * std::size_t{kBrickColumns};
}

std::size_t FusedMap::column_of(std::int32_t bx, std::int32_t by, int column) const {
  const std::int32_t n = grid_.size[0];
  const std::int32_t x = wrap(bx * kBrickEdge, n) + (column >> 3);
  const std::int32_t y = wrap(by * kBrickEdge, n) + (column & 7);
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(n) + static_cast<std::size_t>(x);
}

AddResult FusedMap::add(const WindowMap& map) {
  const bool first = window_.maps().empty();
  const AddResult result = window_.add(map);
  if (result != AddResult::added) return result;
  Change change{&map, &window_.left(), grid_, false};
  grid_.origin = window_.maps().front().view.grid.origin;
  if (first) change.before.size = {0, 0, 0};  // nothing was there: every brick is new
  change.moved_in_z = grid_.origin[2] != change.before.origin[2];
  if (memory_.on()) memory_.begin(window_);
  const Int3 n = grid_.bricks();
  for (std::int32_t by = 0; by < n[1]; ++by)
    for (std::int32_t bx = 0; bx < n[0]; ++bx)
      update_brick_column(brick_origin(grid_, 0) + bx, brick_origin(grid_, 1) + by, change);
  return result;
}

void FusedMap::update_brick_column(std::int32_t bx, std::int32_t by, const Change& change) {
  const std::int32_t low = brick_origin(grid_, 2);
  const bool stack_enters = change.before.size[0] == 0 || change.before.stack_of_brick(bx, by) < 0;
  bool entered = change.moved_in_z;
  if (memory_.on()) memory_.begin_stack(bx, by, stack_of(bx, by), stack_enters);
  for (std::int32_t bz = low; bz < low + grid_.bricks()[2]; ++bz) {
    const Int3 brick{bx, by, bz};
    const std::uint32_t slot = slot_of(brick);
    const bool enters = change.before.slot_of_brick(brick) < 0;
    entered |= enters;
    bool changed = enters || change.moved_in_z;
    if (enters)
      refill(brick, slot);
    else
      changed |= update_brick(brick, slot, change);
    if (memory_.on()) remember_brick(brick, slot, change);
    if (changed) rebuild_masks(brick, slot);
  }
  update_last_seen(bx, by, change, entered);
  update_lowest_ray(bx, by, change, stack_enters);
}

bool FusedMap::update_brick(const Int3& brick, std::uint32_t slot, const Change& change) {
  bool changed = memory_.on() && memory_.expire(slot, cells_of(slot));
  const std::int32_t added = change.added->view.brick_at(brick);
  if (added >= 0) {
    if (memory_.on()) memory_.give_way(slot, change.added->view.lookup_of(added), cells_of(slot));
    add_brick(slot, change.added->view, added);
    changed = true;
  }
  for (const WindowMap& left : *change.left) {
    const std::int32_t gone = left.view.brick_at(brick);
    if (gone < 0) continue;
    subtract_brick(slot, left.view, gone, brick);
    changed = true;
  }
  return changed;
}

void FusedMap::remember_brick(const Int3& brick, std::uint32_t slot, const Change& change) {
  for (std::size_t i = 0; i < change.left->size(); ++i) {
    const std::int32_t gone = (*change.left)[i].view.brick_at(brick);
    if (gone >= 0) memory_.remember(slot, i, gone);
  }
}

void FusedMap::refill(const Int3& brick, std::uint32_t slot) {
  if (live_[slot] || (memory_.on() && memory_.shows_any(slot))) {
    const std::size_t begin = std::size_t{slot} * kBrickCells;
    std::fill_n(hits_.data() + begin, kBrickCells, 0);
    std::fill_n(passes_.data() + begin, kBrickCells, 0);
    std::fill_n(min_height_m_.data() + begin, kBrickCells, kNoHeight_m);
    live_[slot] = 0;
    hit_cells_[slot] = 0;
  }
  if (memory_.on()) memory_.forget(slot);
  for (const WindowMap& map : window_.maps()) {
    const std::int32_t index = map.view.brick_at(brick);
    if (index >= 0) add_brick(slot, map.view, index);
  }
}

void FusedMap::add_brick(std::uint32_t slot, const BrickMapView& map, std::int32_t brick) {
  const std::int32_t* lookup = map.lookup_of(brick);
  const std::size_t begin = std::size_t{slot} * kBrickCells;
  live_[slot] = 1;
  add_free_passes<1>(lookup, passes_.data() + begin);
  for_each_cell(at_least(lookup, 0), [&](std::size_t cell) {
    const VoxelRecord& record = map.records[lookup[cell]];
    if (hits_[begin + cell] == 0) ++hit_cells_[slot];
    add_record(record, cell_at(begin + cell));
  });
}

void FusedMap::subtract_brick(std::uint32_t slot, const BrickMapView& map, std::int32_t brick,
                              const Int3& world_brick) {
  const std::int32_t* lookup = map.lookup_of(brick);
  const std::size_t begin = std::size_t{slot} * kBrickCells;
  add_free_passes<-1>(lookup, passes_.data() + begin);
  for_each_cell(at_least(lookup, 0), [&](std::size_t cell) {
    const VoxelRecord& record = map.records[lookup[cell]];
    const FusedCell fused = cell_at(begin + cell);
    const bool stale = subtract_record(record, fused);
    if (fused.hits == 0) --hit_cells_[slot];
    if (!stale) return;
    stale_.push_back({static_cast<std::uint32_t>(cell), fused.hits, fused.min_height_m});
    fused.min_height_m = kNoHeight_m;
  });
  restore_minima(world_brick, slot);
}

void FusedMap::restore_minima(const Int3& brick, std::uint32_t slot) {
  const std::size_t begin = std::size_t{slot} * kBrickCells;
  for (const WindowMap& map : window_.maps()) {
    if (stale_.empty()) return;
    const std::int32_t index = map.view.brick_at(brick);
    if (index < 0) continue;
    const std::int32_t* lookup = map.view.lookup_of(index);
    for (std::size_t i = stale_.size(); i-- > 0;) {
      StaleMinimum& stale = stale_[i];
      if (lookup[stale.cell] < 0) continue;
      const VoxelRecord& record = map.view.records[lookup[stale.cell]];
      float& lowest_m = min_height_m_[begin + stale.cell];
      lowest_m = lower(lowest_m, record.min_height_m);
      stale.hits -= record.hits;
      // All maps that hit this voxel were seen, or none can be lower.
      if (stale.hits != 0 && lowest_m != stale.least_m) continue;
      stale = stale_.back();
      stale_.pop_back();
    }
  }
  stale_.clear();
}

VoxelBits FusedMap::read_bits(std::uint32_t slot) const {
  const std::size_t begin = std::size_t{slot} * kBrickCells;
  const bool shows = memory_.on() && memory_.shows_any(slot);
  VoxelBits bits{};
  if (live_[slot] || shows) bits.free = at_least(passes_.data() + begin, 1);
  if (hit_cells_[slot] > 0 || shows) {
    bits.occupied = at_least(hits_.data() + begin, min_hits_);
    const CellBits hit = at_least(hits_.data() + begin, 1);
    for (std::size_t c = 0; c < hit.size(); ++c)
      bits.free[c] = static_cast<std::uint8_t>((bits.free[c] | hit[c]) & ~bits.occupied[c]);
  }
  return bits;
}

void FusedMap::rebuild_masks(const Int3& brick, std::uint32_t slot) {
  VoxelBits bits = read_bits(slot);
  const CellBits* remembered = nullptr;
  if (memory_.on()) {
    memory_.show(slot, static_cast<std::uint32_t>(min_hits_), cells_of(slot), bits);
    remembered = &memory_.shown(slot);
    write_mask(brick, *remembered, remembered_);
  }
  write_mask(brick, bits.occupied, occupied_);
  write_mask(brick, bits.free, free_);
  unsigned any = 0;
  for (std::size_t c = 0; c < bits.free.size(); ++c) {
    const int seen = remembered != nullptr ? ~(*remembered)[c] : ~0;
    any |= static_cast<unsigned>((bits.occupied[c] | bits.free[c]) & seen);
  }
  live_[slot] = any != 0;
}

// A brick is eight bits of its columns' masks: byte z / 8 (little-endian, as all machines with CUDA are).
void FusedMap::write_mask(const Int3& brick, const CellBits& bits, std::vector<std::uint64_t>& mask) const {
  const std::size_t mask_bytes = static_cast<std::size_t>(words_) * sizeof(std::uint64_t);
  auto* bytes = reinterpret_cast<std::uint8_t*>(mask.data()) + column_of(brick[0], brick[1], 0) * mask_bytes +
                static_cast<std::size_t>(brick[2] - brick_origin(grid_, 2));
  for (std::size_t y = 0; y < kBrickEdge; ++y)
    for (std::size_t x = 0; x < kBrickEdge; ++x)
      bytes[(y * static_cast<std::size_t>(grid_.size[0]) + x) * mask_bytes] = bits[x * kBrickEdge + y];
}

void FusedMap::reset() {
  window_.clear();
  std::fill(hits_.begin(), hits_.end(), 0);
  std::fill(passes_.begin(), passes_.end(), 0);
  std::fill(min_height_m_.begin(), min_height_m_.end(), kNoHeight_m);
  std::fill(live_.begin(), live_.end(), 0);
  std::fill(hit_cells_.begin(), hit_cells_.end(), 0);
  std::fill(occupied_.begin(), occupied_.end(), 0);
  std::fill(free_.begin(), free_.end(), 0);
  std::fill(remembered_.begin(), remembered_.end(), 0);
  if (memory_.on()) memory_.reset();
  std::fill(last_seen_ns_.begin(), last_seen_ns_.end(), kNeverSeen);
  std::fill(lowest_ray_m_.begin(), lowest_ray_m_.end(), kNoRay_m);
}

}  // namespace gvom::cpu
