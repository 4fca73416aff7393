// What is measured. Everything of the host runs on one thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/backend.hpp"
#include "tools/benchmark/drive.hpp"
#include "tools/benchmark/least_bytes.hpp"
#include "tools/benchmark/samples.hpp"

namespace gvom::bench {

struct VoxelizingTimes {
  std::string details;  ///< What the back end says of itself.
  Samples count;
  Samples write;
  Samples both;
  NamedSamples kernels;        ///< Where they are timed.
  std::vector<OwnedMap> maps;  ///< One for each sweep that came.
};

/// Whether a device times each kernel by itself too: what is around it then takes longer.
enum class Kernels { together, timed };

/// Returns to buffer maps, `runs` sweeps of the recording, which begins anew at its end. A device gets the
/// returns in pageable memory, as a decoder leaves them, and writes the map to pinned memory.
DeviceExpected<VoxelizingTimes> measure_voxelizing(Backend which, const MapConfig& config,
                                                   const Recording& recording, std::size_t runs,
                                                   Kernels kernels = Kernels::together);

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

/// What a device says of its ticks, by its own clock.
struct DeviceTimes {
  std::string details;  ///< What the back end says of itself.
  Samples upload;
  Samples fuse;
  Samples layers;
  Samples download;
  std::uint64_t launches = 0;  ///< The most of any tick.
  double bytes_up = 0;         ///< The mean of the ticks, as the following.
  double bytes_down = 0;
  LeastBytes least_bytes;
};

/// The layers after a tick.
struct KeptLayers {
  int tick;
  std::vector<std::byte> bytes;
};

/// By the clock of the host; `both` is from a new map in memory to layers in memory.
struct TickTimes {
  Samples fuse;
  Samples layers;
  Samples both;
  double bricks_entering = 0;  ///< In each tick, the mean.
  std::optional<DeviceTimes> device;
  NamedSamples kernels;  ///< Where they are timed.
  std::vector<KeptLayers> kept;
};

/// Measures a stretch of a drive.
/// @param kept_ticks whose layers are kept, to be compared
DeviceExpected<TickTimes> measure_ticks(Backend which, const Drive& drive, const Stretch& stretch,
                                        const std::vector<int>& kept_ticks = {},
                                        Kernels kernels = Kernels::together);

}  // namespace gvom::bench
