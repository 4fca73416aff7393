#include "core/cuda/fused_map.hpp"

#include <algorithm>
#include <new>

#include "core/cuda/fill.hpp"
#include "core/cuda/fuse_kernels.hpp"
#include "core/cuda/launch.hpp"
#include "core/cuda/lowest_ray_kernels.hpp"
#include "core/cuda/memory_kernels.hpp"

namespace gvom::cuda {

FusedMap::FusedMap(Device& device, const MapperConfig& config, std::size_t most_maps)
    : device_(device),
      grid_(grid_around(config.map, Eigen::Vector3d::Zero())),
      words_((config.map.size_z + 63) / 64),
      beats_remembered_(beats_remembered(config.memory.max_age_s)),
      tick_bytes_(sizeof(FuseTick) + most_maps * sizeof(DeviceMap)) {
  const std::size_t slots = grid_.brick_slots();
  const std::size_t cells = slots * kBrickCells;
  bricks_ = {grid_.bricks(), device.array<std::uint32_t>(cells), device.array<std::uint32_t>(cells),
             device.array<float>(cells)};
  occupied_ = static_cast<std::uint64_t*>(device.allocate(mask_bytes()));
  free_ = static_cast<std::uint64_t*>(device.allocate(mask_bytes()));
  last_seen_ns_ = device.array<std::int64_t>(columns());
  lowest_ray_m_ = device.array<float>(columns());
  if (beats_remembered_ > 0) take_memory();
  tick_ = device.array<std::byte>(tick_bytes_);
  staged_ = device.pinned_array<std::byte>(kStaged * tick_bytes_);
  listed_ = device.array<std::uint32_t>(slots);
  listed_count_ = device.array<std::uint32_t>(1);
  clear();
  device.clear(listed_count_, sizeof *listed_count_);
  record(static_cast<std::uint32_t>(config.layers.min_hits));
}

// Bricks that enter the grid write theirs before it is read.
void FusedMap::take_memory() {
  const std::size_t slots = grid_.brick_slots();
  memory_ = {device_.array<RememberedHits>(slots * kBrickCells),
             device_.array<RememberedPasses>(slots * kBrickCells),
             device_.array<std::uint16_t>(slots * DeviceMemory::kHalves),
             static_cast<std::uint64_t*>(device_.allocate(mask_bytes())),
             device_.array<std::uint8_t>(columns()),
             device_.array<float>(columns()),
             device_.array<float>(kSpans * columns())};
  bricks_.shown = device_.array<std::uint8_t>(slots * kBrickColumns);
}

void FusedMap::record(std::uint32_t min_hits) {
  const auto* tick = reinterpret_cast<const FuseTick*>(tick_);
  auto* const occupied = reinterpret_cast<std::uint8_t*>(occupied_);
  auto* const free = reinterpret_cast<std::uint8_t*>(free_);
  update_ = device_.record([=] {
    const auto slots = static_cast<std::int32_t>(grid_.brick_slots());
    const std::int32_t stacks = grid_.bricks()[0] * grid_.bricks()[1];
    device_.clear(listed_count_, sizeof *listed_count_);
    for_each_warp(device_, (slots + kLanes - 1) / kLanes,
                  ListChangedBricks{tick, slots, memory_, listed_, listed_count_});
    for_each_warp_counted(device_, listed_count_, UpdateBricks::kPerBrick,
                          UpdateBricks{tick, listed_, bricks_, occupied, free, words_ * 8, min_hits});
    for_each_warp(device_, stacks, UpdateLastSeen{tick, last_seen_ns_, grid_.size[0]});
    for_each_warp(device_, stacks, UpdateLowestRays{tick, lowest_ray_m_});
    if (beats_remembered_ == 0) return;
    for_each_warp_counted(
        device_, listed_count_, UpdateMemory::kPerBrick,
        UpdateMemory{tick, listed_, bricks_, memory_, occupied, free, words_ * 8, min_hits});
    for_each_warp(device_, stacks, RememberStacks{tick, memory_});
  });
}

std::size_t FusedMap::columns() const {
  return static_cast<std::size_t>(grid_.size[0]) * static_cast<std::size_t>(grid_.size[1]);
}

FusedView FusedMap::view() const {
  return {grid_.size[0],
          grid_.size[2],
          words_,
          toroidal_origin(grid_),
          bricks_.hits,
          bricks_.passes,
          bricks_.min_height_m,
          occupied_,
          free_,
          last_seen_ns_,
          lowest_ray_m_,
          {memory_.remembered, memory_.hits, memory_.passes, memory_.column_beats, memory_.lowest_ray_m}};
}

void FusedMap::clear() {
  const auto cells = static_cast<std::int32_t>(grid_.brick_slots() * kBrickCells);
  device_.clear(bricks_.hits, static_cast<std::size_t>(cells) * sizeof *bricks_.hits);
  device_.clear(bricks_.passes, static_cast<std::size_t>(cells) * sizeof *bricks_.passes);
  for_each(device_, cells, Fill<float>{bricks_.min_height_m, kNoHeight_m});
  device_.clear(occupied_, mask_bytes());
  device_.clear(free_, mask_bytes());
  for_each(device_, static_cast<std::int32_t>(columns()), Fill<std::int64_t>{last_seen_ns_, kNeverSeen});
  for_each(device_, static_cast<std::int32_t>(columns()), Fill<float>{lowest_ray_m_, kNoRay_m});
  empty_ = true;
}

void FusedMap::copy_lowest_rays(const Grid& grid, float* lowest_ray_m) {
  for_each(device_, static_cast<std::int32_t>(columns()), CopyRays{grid, lowest_ray_m_, lowest_ray_m});
}

void FusedMap::update(const Window& window, std::uint32_t added_place, const MapRing& ring) {
  if (device_.failed()) return;
  std::byte* const staged = next_staged();
  const std::size_t bytes = write_tick(window, added_place, ring, staged);
  grid_ = window.maps().front().view.grid;
  newest_beat_ = beat_of(window.maps().front().view.stamp_ns);
  empty_ = false;
  device_.upload(tick_, staged, bytes);
  device_.play(update_);
}

// Staged memory is used again only when the device has read it.
std::byte* FusedMap::next_staged() {
  if (staged_ticks_ == kStaged) {
    static_cast<void>(device_.wait());
    settled();
  }
  return staged_ + staged_ticks_++ * tick_bytes_;
}

MemoryTick FusedMap::memory_tick(std::int64_t newest_ns) const {
  if (beats_remembered_ == 0) return {};
  const std::int64_t now = beat_of(newest_ns), before = empty_ ? now : newest_beat_;
  const std::int64_t spans = span_of(now, beats_remembered_) - span_of(before, beats_remembered_);
  return {now, beats_remembered_, static_cast<std::int32_t>(std::min<std::int64_t>(spans, kSpans)),
          now - before > beats_remembered_};
}

std::size_t FusedMap::write_tick(const Window& window, std::uint32_t added_place, const MapRing& ring,
                                 std::byte* to) const {
  auto* tick = new (to) FuseTick{};
  tick->grid = window.maps().front().view.grid;
  tick->before = grid_;
  if (empty_) tick->before.size = {0, 0, 0};
  tick->moved_in_z = tick->grid.origin[2] != tick->before.origin[2];
  tick->memory = memory_tick(window.maps().front().view.stamp_ns);
  tick->window_maps = static_cast<std::int32_t>(window.maps().size());
  tick->left_maps = static_cast<std::int32_t>(window.left().size());
  auto* next = reinterpret_cast<DeviceMap*>(tick + 1);
  for (const WindowMap& map : window.maps()) {
    if (map.place == added_place) tick->added = static_cast<std::int32_t>(&map - window.maps().data());
    *next++ = ring.map(map.place);
  }
  for (const WindowMap& map : window.left()) *next++ = ring.map(map.place);
  return static_cast<std::size_t>(reinterpret_cast<std::byte*>(next) - to);
}

}  // namespace gvom::cuda
