#include "tools/benchmark/gpu_report.hpp"
#include "tools/benchmark/gpu_stages.hpp"

namespace gvom::bench {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Samples& samples) {
  return {
      {"p50_ms", samples.quantile_ms(0.5)}, {"p99_ms", samples.quantile_ms(0.99)}, {"runs", samples.size()}};
}

Json json_of(const MapConfig& grid) {
  return {{"size_xy", grid.size_xy}, {"size_z", grid.size_z}};
}

Json json_of(const VoxelizingTimes& times) {
  return {{"count", json_of(times.count)}, {"write", json_of(times.write)}, {"both", json_of(times.both)}};
}

Json json_of(const TickTimes& times) {
  return {{"tick", json_of(times.both)}, {"fuse", json_of(times.fuse)}, {"layers", json_of(times.layers)}};
}

// The device's stages in place of the host's.
Json json_of(const TickTimes& times, const DeviceTimes& device, const cuda::CopyRates& rates) {
  Json json{{"tick", json_of(times.both)},     {"floor_ms", floor_ms(device, rates)},
            {"launches", device.launches},     {"bytes_up", device.bytes_up},
            {"bytes_down", device.bytes_down}, {"device", device.details}};
  for (const Stage& stage : stages_of(device, rates)) {
    json[stage.name] = json_of(stage.times);
    json[stage.name]["least_bytes"] = stage.least_bytes;
    json[stage.name]["share_of_copy_rate"] = stage.share();
  }
  return json;
}

Json json_of(const TickRow& row, const cuda::CopyRates& rates) {
  Json json{{"grid", json_of(row.map)},
            {"window", row.window},
            {"bricks_entering", row.bricks_entering()},
            {"cpu", json_of(row.cpu)}};
  json["cuda"] =
      row.cuda ? json_of(*row.cuda, *row.cuda->device, rates) : Json{{"does_not_fit", row.cuda.error()}};
  return json;
}

}  // namespace

Json to_json(const Setting& setting, const GpuComparison& comparison) {
  const cuda::CopyRates& rates = comparison.rates;
  Json json = to_json(setting);
  json["device"] = comparison.cuda_voxelizing.details;
  json["copy_bytes_per_s"] = {
      {"to_device", rates.to_device}, {"to_host", rates.to_host}, {"within_device", rates.within_device}};
  json["voxelizing"] = {{"grid", json_of(comparison.voxelized)},
                        {"cpu", json_of(comparison.cpu_voxelizing)},
                        {"cuda", json_of(comparison.cuda_voxelizing)}};
  for (const TickRow& row : comparison.rows) json["ticks"].push_back(json_of(row, rates));
  for (const KernelTable& table : comparison.kernels)
    for (const NamedSamples::Step& step : table.kernels.steps())
      json["kernels"][table.of][step.name] = json_of(step.times);
  return json;
}

}  // namespace gvom::bench
