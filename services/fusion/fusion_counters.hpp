// What fusion counts and measures, as Health tells it. Every map that is dropped is in exactly one of these.
#pragma once

#include <cstdint>

#include "core/backend.hpp"
#include "core/window.hpp"
#include "ipc/brick_map.hpp"
#include "services/common/health.hpp"

namespace gvom::fusion {

struct FusionCounters {
  explicit FusionCounters(services::HealthReport& health);

  /// Counts a map that the window does not take.
  void count_drop(AddResult result);
  /// Counts a map that leads nowhere.
  void count_drop(ipc::MapFault::Part part);

  std::uint64_t& maps_in;
  std::uint64_t& maps_fused;
  std::uint64_t& maps_lost;  // gaps in their sequences
  std::uint64_t& drop_map_too_old;
  std::uint64_t& drop_map_duplicate;
  std::uint64_t& drop_map_wrong_grid;
  std::uint64_t& drop_map_old_epoch;
  std::uint64_t& drop_map_before_jump;
  std::uint64_t& drop_map_refused;        // not readable: version, size
  std::uint64_t& drop_map_bad_directory;  // readable, but an array does not hold what it can
  std::uint64_t& drop_map_bad_lookup;
  std::uint64_t& drop_map_bad_columns;
  std::uint64_t& drop_map_bad_records;
  std::uint64_t& drop_map_backend_failed;  // the last one then: the process leaves
  std::uint64_t& layers_out;
  std::uint64_t& drop_layers_no_chunk;
  std::uint64_t& voxel_maps_out;
  std::uint64_t& drop_voxels_no_chunk;
  std::uint64_t& epochs;
  std::uint64_t& odometry_jumps;
  services::StageHistogram& fuse;
  services::StageHistogram& make_layers;
  services::StageHistogram& received_to_layers;
};

/// What a device measures of itself.
struct DeviceStages {
  explicit DeviceStages(services::HealthReport& health);

  void record(const DeviceCosts& costs);

  services::StageHistogram& upload;
  services::StageHistogram& fuse;
  services::StageHistogram& layers;
  services::StageHistogram& download;
};

}  // namespace gvom::fusion
