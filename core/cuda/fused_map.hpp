// The fused map (R7, R8) in the device's memory, kept up to date as the CPU's is.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/cuda/device.hpp"
#include "core/cuda/device_memory.hpp"
#include "core/cuda/fuse_tick.hpp"
#include "core/cuda/map_ring.hpp"
#include "core/window.hpp"

namespace gvom::cuda {

class FusedMap {
 public:
  /// @param most_maps that a tick can name: those of the window and those that leave it
  FusedMap(Device& device, const MapperConfig& config, std::size_t most_maps);

  /// Fuses the map that the window took last. All of the window's maps, and those that left it, are in
  /// `ring`.
  void update(const Window& window, std::uint32_t added_place, const MapRing& ring);
  void clear();
  /// Writes the lowest rays (R5a) in the order of a map of `grid`, to memory of the device.
  void copy_lowest_rays(const Grid& grid, float* lowest_ray_m);
  /// The device has done all that was asked of it so far.
  void settled() { staged_ticks_ = 0; }

  [[nodiscard]] const DenseBricks& bricks() const { return bricks_; }
  /// Pointers of the device.
  [[nodiscard]] FusedView view() const;
  /// Those that it is the sum of.
  [[nodiscard]] WindowMaps window() const { return {reinterpret_cast<const FuseTick*>(tick_)}; }

 private:
  std::size_t write_tick(const Window& window, std::uint32_t added_place, const MapRing& ring,
                         std::byte* to) const;
  std::byte* next_staged();
  void take_memory();
  void record(std::uint32_t min_hits);
  [[nodiscard]] MemoryTick memory_tick(std::int64_t newest_ns) const;
  [[nodiscard]] std::size_t columns() const;
  [[nodiscard]] std::size_t mask_bytes() const { return columns() * static_cast<std::size_t>(words_) * 8; }

  // Ticks that may be on their way to the device at a time.
  static constexpr std::size_t kStaged = 8;

  Device& device_;
  Grid grid_;
  bool empty_ = true;
  DenseBricks bricks_;
  std::int32_t words_;
  std::uint64_t* occupied_;
  std::uint64_t* free_;
  std::int64_t* last_seen_ns_;
  float* lowest_ray_m_;
  std::int32_t beats_remembered_;  // 0: nothing is
  DeviceMemory memory_{};
  std::int64_t newest_beat_ = 0;  // of the memory
  std::byte* tick_;               // a FuseTick and its maps
  std::size_t tick_bytes_;        // room for it
  std::byte* staged_;             // pinned, kStaged times
  std::size_t staged_ticks_ = 0;
  std::uint32_t* listed_;
  std::uint32_t* listed_count_;
  Device::Graph update_;
};

}  // namespace gvom::cuda
