// What fusion counts and measures, as Health tells it. Every map that is dropped is in exactly one of these.
#pragma once

#include <array>
#include <cstdint>

#include "core/backend.hpp"
#include "core/window.hpp"
#include "ipc/brick_map.hpp"
#include "services/common/health.hpp"
#include "services/fusion/map_trust.hpp"

namespace gvom::fusion {

struct FusionCounts {
  std::uint64_t maps_in = 0;
  std::uint64_t maps_fused = 0;
  std::uint64_t lost_maps = 0;
  std::uint64_t too_old_maps = 0;
  std::uint64_t duplicate_maps = 0;
  std::uint64_t maps_of_wrong_grid = 0;
  std::uint64_t maps_of_old_epoch = 0;
  std::uint64_t maps_before_jump = 0;
  std::uint64_t refused_maps = 0;
  std::uint64_t bad_directories = 0;
  std::uint64_t bad_lookups = 0;
  std::uint64_t bad_columns = 0;
  std::uint64_t bad_lowest_rays = 0;
  std::uint64_t bad_records = 0;
  std::uint64_t bad_epochs = 0;
  std::uint64_t bad_times = 0;
  std::uint64_t backend_failures = 0;
  std::uint64_t maps_sharing_layers = 0;
  std::uint64_t layers_out = 0;
  std::uint64_t layers_without_chunk = 0;
  std::uint64_t voxel_maps_out = 0;
  std::uint64_t voxels_without_chunk = 0;
  std::uint64_t epochs = 0;
  std::uint64_t odometry_jumps = 0;

  /// A map that the window does not take.
  void count_drop(AddResult result);
  /// A map that leads nowhere.
  void count_drop(ipc::MapFault::Part part);
  /// A map that cannot be what it says.
  void count_drop(MapLie::About about);
};

/// A counter of Health.
struct CounterRow {
  const char* name;  ///< In Health; `drop_` for what was not used.
  std::uint64_t FusionCounts::*value;
};

inline constexpr CounterRow kFusionCounters[] = {
    {"maps_in", &FusionCounts::maps_in},
    {"maps_fused", &FusionCounts::maps_fused},
    {"maps_lost", &FusionCounts::lost_maps},  // gaps in their sequences
    {"drop_map_too_old", &FusionCounts::too_old_maps},
    {"drop_map_duplicate", &FusionCounts::duplicate_maps},
    {"drop_map_wrong_grid", &FusionCounts::maps_of_wrong_grid},
    {"drop_map_old_epoch", &FusionCounts::maps_of_old_epoch},
    {"drop_map_before_jump", &FusionCounts::maps_before_jump},
    {"drop_map_refused", &FusionCounts::refused_maps},           // not readable: version, size
    {"drop_map_bad_directory", &FusionCounts::bad_directories},  // readable, but it leads nowhere
    {"drop_map_bad_lookup", &FusionCounts::bad_lookups},
    {"drop_map_bad_columns", &FusionCounts::bad_columns},
    {"drop_map_bad_lowest_rays", &FusionCounts::bad_lowest_rays},
    {"drop_map_bad_records", &FusionCounts::bad_records},
    {"drop_map_bad_epoch", &FusionCounts::bad_epochs},  // announced by no odometry
    {"drop_map_bad_time", &FusionCounts::bad_times},    // received, measured or jumped in the future
    {"drop_map_backend_failed", &FusionCounts::backend_failures},  // the last one then: the process leaves
    {"maps_sharing_layers", &FusionCounts::maps_sharing_layers},   // fused, and first seen with later ones
    {"layers_out", &FusionCounts::layers_out},
    {"drop_layers_no_chunk", &FusionCounts::layers_without_chunk},
    {"voxel_maps_out", &FusionCounts::voxel_maps_out},
    {"drop_voxels_no_chunk", &FusionCounts::voxels_without_chunk},
    {"epochs", &FusionCounts::epochs},
    {"odometry_jumps", &FusionCounts::odometry_jumps},
};

/// The counts of the process and how Health gets them.
class FusionCounters : public FusionCounts {
 public:
  explicit FusionCounters(services::HealthReport& health);

  /// Puts everything into the next Health.
  void report();

  services::StageHistogram& fuse;
  services::StageHistogram& make_layers;
  services::StageHistogram& received_to_layers;

 private:
  std::array<std::uint64_t*, std::size(kFusionCounters)> reported_{};
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
