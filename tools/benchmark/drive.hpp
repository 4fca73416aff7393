// Ticks to measure: an endless drive on the sweeps of a recording.
#pragma once

#include <vector>

#include "tools/benchmark/memory.hpp"
#include "tools/benchmark/recording.hpp"

namespace gvom::bench {

/// The maps of a grid, one after the other, lap after lap. Each lap begins where the one before has ended, in
/// whole bricks, so the vehicle never turns, and bricks enter and leave all the time.
struct Drive {
  const Recording& recording;
  const std::vector<OwnedMap>& maps;  ///< Of each sweep.
  MapConfig map;
  int window;
  MemoryConfig memory = {};

  [[nodiscard]] std::size_t columns() const {
    return static_cast<std::size_t>(map.size_xy) * static_cast<std::size_t>(map.size_xy);
  }
  /// How far a lap goes, world voxels: whole bricks.
  [[nodiscard]] Int3 lap() const;
  [[nodiscard]] const BrickMapView& map_of_tick(int tick) const;
  /// That map at `begin`, with the stamp and in the place of its tick.
  BrickMapView copy_map_of_tick(int tick, std::byte* begin) const;
};

/// Ticks begin .. end - 1 of a drive, measured with a full window.
struct Stretch {
  int begin;
  int end;
};

/// Ticks before a stretch that nobody measures: they fill the window and the memory, and warm up.
int ticks_before(const Drive& drive);

/// Bricks of `grid` that `before` does not reach.
std::uint32_t bricks_entering(const Grid& grid, const Grid& before);

/// Where the maps of a drive come and its layers go: one piece of memory, which a device can reach.
class DriveMemory {
 public:
  explicit DriveMemory(const Drive& drive);

  [[nodiscard]] HostMemory whole() { return memory_.whole(); }
  /// Where the map of a tick lies until it has left the window.
  [[nodiscard]] std::byte* map_of_tick(int tick) {
    return memory_.begin() + layers_bytes_ + static_cast<std::size_t>(tick) % places_ * most_map_bytes_;
  }
  [[nodiscard]] std::byte* layers() { return memory_.begin(); }
  [[nodiscard]] std::size_t layers_bytes() const { return layers_bytes_; }

 private:
  std::size_t layers_bytes_;
  std::size_t most_map_bytes_;
  std::size_t places_;
  Memory memory_;
};

}  // namespace gvom::bench
