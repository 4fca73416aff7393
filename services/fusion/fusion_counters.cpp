#include "services/fusion/fusion_counters.hpp"

namespace gvom::fusion {

namespace {

void record_ms(double duration_ms, services::StageHistogram& stage) {
  stage.record_ns(static_cast<std::int64_t>(duration_ms * 1e6));
}

}  // namespace

FusionCounters::FusionCounters(services::HealthReport& health)
    : maps_in(health.counter("maps_in")),
      maps_fused(health.counter("maps_fused")),
      maps_lost(health.counter("maps_lost")),
      drop_map_too_old(health.counter("drop_map_too_old")),
      drop_map_duplicate(health.counter("drop_map_duplicate")),
      drop_map_wrong_grid(health.counter("drop_map_wrong_grid")),
      drop_map_old_epoch(health.counter("drop_map_old_epoch")),
      drop_map_before_jump(health.counter("drop_map_before_jump")),
      drop_map_refused(health.counter("drop_map_refused")),
      drop_map_bad_directory(health.counter("drop_map_bad_directory")),
      drop_map_bad_lookup(health.counter("drop_map_bad_lookup")),
      drop_map_bad_columns(health.counter("drop_map_bad_columns")),
      drop_map_bad_records(health.counter("drop_map_bad_records")),
      drop_map_backend_failed(health.counter("drop_map_backend_failed")),
      layers_out(health.counter("layers_out")),
      drop_layers_no_chunk(health.counter("drop_layers_no_chunk")),
      voxel_maps_out(health.counter("voxel_maps_out")),
      drop_voxels_no_chunk(health.counter("drop_voxels_no_chunk")),
      epochs(health.counter("epochs")),
      odometry_jumps(health.counter("odometry_jumps")),
      fuse(health.stage("fuse")),
      make_layers(health.stage("make_layers")),
      received_to_layers(health.stage("received_to_layers")) {}

void FusionCounters::count_drop(AddResult result) {
  switch (result) {
    case AddResult::too_old:
      ++drop_map_too_old;
      break;
    case AddResult::duplicate:
      ++drop_map_duplicate;
      break;
    case AddResult::wrong_grid:
      ++drop_map_wrong_grid;
      break;
    case AddResult::added:
      break;
  }
}

void FusionCounters::count_drop(ipc::MapFault::Part part) {
  switch (part) {
    case ipc::MapFault::Part::directory:
      ++drop_map_bad_directory;
      break;
    case ipc::MapFault::Part::lookup:
      ++drop_map_bad_lookup;
      break;
    case ipc::MapFault::Part::columns:
      ++drop_map_bad_columns;
      break;
    case ipc::MapFault::Part::records:
      ++drop_map_bad_records;
      break;
  }
}

DeviceStages::DeviceStages(services::HealthReport& health)
    : upload(health.stage("device_upload")),
      fuse(health.stage("device_fuse")),
      layers(health.stage("device_layers")),
      download(health.stage("device_download")) {}

void DeviceStages::record(const DeviceCosts& costs) {
  record_ms(costs.upload_ms, upload);
  record_ms(costs.fuse_ms, fuse);
  record_ms(costs.layers_ms, layers);
  record_ms(costs.download_ms, download);
}

}  // namespace gvom::fusion
