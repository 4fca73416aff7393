#include <algorithm>

#include "core/open_backend.hpp"
#include "tools/benchmark/measure.hpp"

namespace gvom::bench {

namespace {

constexpr std::int64_t kTick_ns = 100'000'000;
constexpr int kWarmUpTicks = 10;  // with a full window

std::size_t most_map_bytes(const std::vector<OwnedMap>& maps) {
  std::size_t most = 0;
  for (const OwnedMap& map : maps) most = std::max(most, map.view.bytes_in_one);
  return most;
}

FusionSetup setup_of(const Drive& drive, const HostMemory& shared) {
  FusionSetup setup;
  setup.config.map = drive.map;
  setup.config.window.buffer_size = drive.window;
  setup.config.window.max_age_s = 3600;
  setup.shared = shared;
  for (const OwnedMap& map : drive.maps)
    setup.max_returns = std::max(setup.max_returns, std::size_t{map.view.shape.record_count});
  return setup;
}

// Times of a device; bytes are summed up.
void add(const DeviceCosts& costs, const LeastBytes& bytes, DeviceTimes& times) {
  times.upload.add(costs.upload_ms);
  times.fuse.add(costs.fuse_ms);
  times.layers.add(costs.layers_ms);
  times.download.add(costs.download_ms);
  times.launches = std::max(times.launches, costs.launches);
  times.least_bytes = times.least_bytes + bytes;
}

// One tick; its times go to `times`.
DeviceExpected<void> run_tick(FusionBackend& backend, const WindowMap& map, const LayerArrays& layers,
                              TickTimes& times) {
  DeviceExpected<AddResult> added;
  const double fuse_ms = time_ms([&] { added = backend.add(map); });
  if (!added) return tl::make_unexpected(added.error());
  if (*added != AddResult::added) return tl::make_unexpected(DeviceError{"the window refused a map"});
  DeviceExpected<void> made;
  const double layers_ms = time_ms([&] { made = backend.make_layers(layers); });
  if (!made) return made;
  times.fuse.add(fuse_ms);
  times.layers.add(layers_ms);
  times.both.add(fuse_ms + layers_ms);
  if (const auto costs = backend.last_costs()) {
    if (!times.device) times.device.emplace();
    add(*costs, least_bytes(backend.window(), layers), *times.device);
  }
  return {};
}

}  // namespace

DriveMemory::DriveMemory(const Drive& drive)
    : layers_bytes_(bench::layers_bytes(drive.columns())),
      most_map_bytes_(most_map_bytes(drive.maps)),
      places_(static_cast<std::size_t>(drive.window) + 2),
      memory_(layers_bytes_ + places_ * most_map_bytes_) {}

DeviceExpected<TickTimes> measure_ticks(Backend which, const Drive& drive, DriveMemory& memory) {
  auto opened = open_fusion(which, setup_of(drive, memory.whole()));
  if (!opened) return tl::make_unexpected(opened.error());
  const LayerArrays layers = layer_arrays(memory.layers(), drive.columns());
  const int first = drive.window + kWarmUpTicks;
  TickTimes warm_up;
  TickTimes times;
  for (int tick = 0; tick < first + drive.ticks; ++tick) {
    const auto k = static_cast<std::size_t>(tick);
    const OwnedMap& map = drive.maps[drive.recording.sweep_of_tick(k)];
    BrickMapView view = copy_map(map.view, memory.map_of_tick(k));
    view.stamp_ns = tick * kTick_ns;
    const auto done = run_tick(*opened->backend, {view, 0, k}, layers, tick < first ? warm_up : times);
    if (!done) return tl::make_unexpected(done.error());
  }
  if (times.device) {
    times.device->details = opened->details;
    times.device->least_bytes = times.device->least_bytes / drive.ticks;
  }
  return times;
}

}  // namespace gvom::bench
