// What is measured. Everything runs on one thread.
#pragma once

#include <cstdint>
#include <vector>

#include "core/brick_map.hpp"
#include "tools/benchmark/recording.hpp"
#include "tools/benchmark/samples.hpp"

namespace gvom::bench {

/// A buffer map in memory of its own.
struct OwnedMap {
  BrickMapView view;
  std::vector<std::int32_t> directory;
  std::vector<std::int32_t> lookup;
  std::vector<std::uint64_t> columns;
  std::vector<VoxelRecord> records;
};

struct IngestTimes {
  Samples count;
  Samples write;
  Samples both;
  Samples straight;            ///< The straight loop over walk_ray, its counters cleared beforehand.
  std::uint64_t passes = 0;    ///< In the grid, of all sweeps.
  bool passes_agree = true;    ///< Of each voxel of each sweep, with those of the straight loop.
  std::vector<OwnedMap> maps;  ///< One for each sweep.
};

/// Returns to buffer maps, sweep by sweep, `repeats` times over the recording.
IngestTimes measure_ingest(const Recording& recording, int repeats);

struct OctomapTimes {
  Samples every_ray;
  Samples discretized;
};

/// OctoMap's insertPointCloud of the same returns, moved to odom beforehand, into one tree of the same
/// resolution. Only in builds with OctoMap (GVOM_OCTOMAP).
OctomapTimes measure_octomap(const Recording& recording, int repeats);

/// Ticks of fusion with a full window.
struct FusionTimes {
  int window = 0;
  Samples fuse;
  Samples layers;
  Samples both;
};

/// The maps fused in the order of `Recording::sweep_of_tick`, each tick's in memory of its own.
FusionTimes measure_fusion(const Recording& recording, const std::vector<OwnedMap>& maps, int window,
                           int ticks);

}  // namespace gvom::bench
