#include "services/fusion/fusion_counters.hpp"

namespace gvom::fusion {

namespace {

void record_ms(double duration_ms, services::StageHistogram& stage) {
  stage.record_ns(static_cast<std::int64_t>(duration_ms * 1e6));
}

}  // namespace

void FusionCounts::count_drop(AddResult result) {
  switch (result) {
    case AddResult::too_old:
      ++too_old_maps;
      break;
    case AddResult::duplicate:
      ++duplicate_maps;
      break;
    case AddResult::wrong_grid:
      ++maps_of_wrong_grid;
      break;
    case AddResult::added:
      break;
  }
}

void FusionCounts::count_drop(ipc::MapFault::Part part) {
  switch (part) {
    case ipc::MapFault::Part::directory:
      ++bad_directories;
      break;
    case ipc::MapFault::Part::lookup:
      ++bad_lookups;
      break;
    case ipc::MapFault::Part::columns:
      ++bad_columns;
      break;
    case ipc::MapFault::Part::lowest_ray:
      ++bad_lowest_rays;
      break;
    case ipc::MapFault::Part::records:
      ++bad_records;
      break;
  }
}

void FusionCounts::count_drop(MapLie::About about) {
  switch (about) {
    case MapLie::About::epoch:
      ++bad_epochs;
      break;
    case MapLie::About::time:
      ++bad_times;
      break;
  }
}

FusionCounters::FusionCounters(services::HealthReport& health)
    : fuse(health.stage("fuse")),
      make_layers(health.stage("make_layers")),
      received_to_layers(health.stage("received_to_layers")) {
  for (std::size_t i = 0; i < reported_.size(); ++i) reported_[i] = &health.counter(kFusionCounters[i].name);
}

void FusionCounters::report() {
  for (std::size_t i = 0; i < reported_.size(); ++i) *reported_[i] = this->*kFusionCounters[i].value;
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
