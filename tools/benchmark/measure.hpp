// What is measured. Everything of the host runs on one thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/backend.hpp"
#include "tools/benchmark/least_bytes.hpp"
#include "tools/benchmark/memory.hpp"
#include "tools/benchmark/recording.hpp"
#include "tools/benchmark/samples.hpp"

namespace gvom::bench {

struct VoxelizingTimes {
  std::string details;  ///< What the back end says of itself.
  Samples count;
  Samples write;
  Samples both;
  std::vector<OwnedMap> maps;  ///< One for each sweep.
};

/// Returns to buffer maps, sweep by sweep, `repeats` times over the recording. A device reads the returns
/// from pageable memory, as a decoder leaves them, and writes the map to pinned memory.
DeviceExpected<VoxelizingTimes> measure_voxelizing(Backend which, const MapConfig& config,
                                                   const Recording& recording, int repeats);

struct StraightTimes {
  Samples times;             ///< The straight loop over walk_ray, its counters cleared beforehand.
  std::uint64_t passes = 0;  ///< In the grid, of all sweeps.
  bool agree = true;         ///< Of each voxel of each sweep, with the passes of the maps.
};

/// The obvious way, `repeats` times over the recording.
/// @param maps of each sweep, from voxelizing with the same `config`
StraightTimes measure_straight(const MapConfig& config, const Recording& recording,
                               const std::vector<OwnedMap>& maps, int repeats);

struct OctomapTimes {
  Samples every_ray;
  Samples discretized;
};

/// OctoMap's insertPointCloud of the same returns, moved to odom beforehand, into one tree of the same
/// resolution. Only in builds with OctoMap (GVOM_OCTOMAP).
OctomapTimes measure_octomap(const Recording& recording, int repeats);

/// Ticks to measure: the maps of a grid, in the order of `Recording::sweep_of_tick`, with a full window.
struct Drive {
  const Recording& recording;
  const std::vector<OwnedMap>& maps;
  MapConfig map;
  int window;
  int ticks;

  [[nodiscard]] std::size_t columns() const {
    return static_cast<std::size_t>(map.size_xy) * static_cast<std::size_t>(map.size_xy);
  }
};

/// Where the maps of a drive come and its layers go: one piece of memory, which a device can reach.
class DriveMemory {
 public:
  explicit DriveMemory(const Drive& drive);

  [[nodiscard]] HostMemory whole() { return memory_.whole(); }
  /// Where the map of a tick lies until it has left the window.
  [[nodiscard]] std::byte* map_of_tick(std::size_t tick) {
    return memory_.begin() + layers_bytes_ + tick % places_ * most_map_bytes_;
  }
  [[nodiscard]] std::byte* layers() { return memory_.begin(); }
  [[nodiscard]] std::size_t layers_bytes() const { return layers_bytes_; }

 private:
  std::size_t layers_bytes_;
  std::size_t most_map_bytes_;
  std::size_t places_;
  Memory memory_;
};

/// What a device says of its ticks, by its own clock.
struct DeviceTimes {
  std::string details;  ///< What the back end says of itself.
  Samples upload;
  Samples fuse;
  Samples layers;
  Samples download;
  std::uint64_t launches = 0;  ///< The most of any tick.
  LeastBytes least_bytes;      ///< The mean of the ticks.
};

/// By the clock of the host; `both` is from a new map in memory to layers in memory.
struct TickTimes {
  Samples fuse;
  Samples layers;
  Samples both;
  std::optional<DeviceTimes> device;
};

/// The last tick's layers stay in `memory`.
DeviceExpected<TickTimes> measure_ticks(Backend which, const Drive& drive, DriveMemory& memory);

}  // namespace gvom::bench
