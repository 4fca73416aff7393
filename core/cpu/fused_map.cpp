#include "core/cpu/fused_map.hpp"

#include <algorithm>

#include "core/cpu/brick_cells.hpp"

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
  solid_.resize(columns * static_cast<std::size_t>(words_));
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
          memory_.on() ? memory_.view(remembered_.data()) : MemoryView{},
          solid_.data()};
}

std::uint32_t FusedMap::slot_of(const Int3& b) const {
  const Int3 n = grid_.bricks();
  return brick_slot(wrap(b[0], n[0]), wrap(b[1], n[1]), wrap(b[2], n[2]), n[0], n[1]);
}

FusedMap::Stack FusedMap::stack_at(std::int32_t bx, std::int32_t by) const {
  const Int3 n = grid_.bricks();
  const std::int32_t x = wrap(bx, n[0]), y = wrap(by, n[1]);
  const auto first = static_cast<std::size_t>(y * grid_.size[0] + x) * kBrickEdge;
  return {bx, by, brick_slot(x, y, 0, n[0], n[1]) * std::size_t{kBrickColumns}, first};
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
      update_stack(stack_at(brick_origin(grid_, 0) + bx, brick_origin(grid_, 1) + by), change);
  return result;
}

void FusedMap::update_stack(const Stack& stack, const Change& change) {
  const std::int32_t low = brick_origin(grid_, 2);
  const bool stack_enters =
      change.before.size[0] == 0 || change.before.stack_of_brick(stack.bx, stack.by) < 0;
  bool entered = change.moved_in_z;
  if (memory_.on()) memory_.begin_stack(stack.bx, stack.by, stack.rays, stack_enters);
  masks_.begin();
  for (std::int32_t bz = low; bz < low + grid_.bricks()[2]; ++bz) {
    const Int3 brick{stack.bx, stack.by, bz};
    const std::uint32_t slot = slot_of(brick);
    const bool enters = change.before.slot_of_brick(brick) < 0;
    entered |= enters;
    bool changed = enters || change.moved_in_z;
    if (enters)
      refill(brick, slot);
    else
      changed |= update_brick(brick, slot, change);
    if (memory_.on()) remember_brick(brick, slot, change);
    if (changed) rebuild_masks(static_cast<std::size_t>(bz - low), slot);
  }
  write_masks(stack);
  update_last_seen(stack, change, entered);
  update_lowest_ray(stack, change, stack_enters);
}

bool FusedMap::update_brick(const Int3& brick, std::uint32_t slot, const Change& change) {
  bool changed = memory_.on() && memory_.expire(slot, cells_of(slot));
  const std::int32_t added = change.added->view.brick_at(brick);
  if (added >= 0) {
    const ObservedBits observed = observed_in(change.added->view.lookup_of(added));
    if (memory_.on()) memory_.give_way(slot, observed, cells_of(slot));
    add_brick(slot, change.added->view, added, observed.hit);
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
    if (index < 0) continue;
    add_brick(slot, map.view, index, observed_in(map.view.lookup_of(index)).hit);
  }
}

void FusedMap::add_brick(std::uint32_t slot, const BrickMapView& map, std::int32_t brick,
                         const CellBits& hit) {
  const std::int32_t* lookup = map.lookup_of(brick);
  const std::size_t begin = std::size_t{slot} * kBrickCells;
  live_[slot] = 1;
  add_free_passes(lookup, passes_.data() + begin);
  for_each_cell(hit, [&](std::size_t cell) {
    const VoxelRecord& record = map.records[lookup[cell]];
    if (hits_[begin + cell] == 0) ++hit_cells_[slot];
    add_record(record, cell_at(begin + cell));
  });
}

void FusedMap::subtract_brick(std::uint32_t slot, const BrickMapView& map, std::int32_t brick,
                              const Int3& world_brick) {
  const std::int32_t* lookup = map.lookup_of(brick);
  const std::size_t begin = std::size_t{slot} * kBrickCells;
  subtract_free_passes(lookup, passes_.data() + begin);
  for_each_cell(observed_in(lookup).hit, [&](std::size_t cell) {
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

void FusedMap::rebuild_masks(std::size_t z, std::uint32_t slot) {
  const BrickCells cells = cells_of(slot);
  const bool shows = memory_.on() && memory_.shows_any(slot);
  VoxelBits bits{};
  if (live_[slot] || shows) bits = voxel_bits(cells.hits, cells.passes, min_hits_);
  CellBits seen = bits.occupied | bits.free;
  if (memory_.on()) {
    memory_.show(slot, static_cast<std::uint32_t>(min_hits_), cells, bits);
    seen = without(seen, memory_.shown(slot));
    masks_.remembered.bricks[z] = memory_.shown(slot);
  }
  live_[slot] = any_of(seen);
  masks_.occupied.bricks[z] = bits.occupied;
  masks_.free.bricks[z] = bits.free;
  masks_.solid.bricks[z] = bits.solid;
  masks_.change(z);
}

void FusedMap::write_masks(const Stack& stack) {
  if (!masks_.any_changed) return;
  const std::size_t first = stack.first * static_cast<std::size_t>(words_);
  const auto write = [&](const StackBits& bits, std::vector<std::uint64_t>& masks) {
    for (int word = 0; word < words_; ++word)
      write_words(bits.bricks.data() + std::ptrdiff_t{word} * kBrickEdge, masks_.changed[word],
                  masks.data() + first + word, {words_, std::ptrdiff_t{grid_.size[0]} * words_});
  };
  write(masks_.occupied, occupied_);
  write(masks_.free, free_);
  write(masks_.solid, solid_);
  if (memory_.on()) write(masks_.remembered, remembered_);
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
  std::fill(solid_.begin(), solid_.end(), 0);
  std::fill(remembered_.begin(), remembered_.end(), 0);
  if (memory_.on()) memory_.reset();
  std::fill(last_seen_ns_.begin(), last_seen_ns_.end(), kNeverSeen);
  std::fill(lowest_ray_m_.begin(), lowest_ray_m_.end(), kNoRay_m);
}

}  // namespace gvom::cpu
