#include <algorithm>
#include <utility>

#include "core/open_backend.hpp"
#include "tools/benchmark/measure.hpp"

namespace gvom::bench {

namespace {

FusionSetup setup_of(const Drive& drive, const HostMemory& shared, Kernels kernels) {
  FusionSetup setup;
  setup.config.map = drive.map;
  setup.config.window.buffer_size = drive.window;
  setup.config.window.max_age_s = 3600;
  setup.config.memory = drive.memory;
  setup.shared = shared;
  setup.times_kernels = kernels == Kernels::timed;
  for (const OwnedMap& map : drive.maps)
    setup.max_returns = std::max(setup.max_returns, std::size_t{map.view.shape.record_count});
  return setup;
}

// Times of a device; the others are summed up.
void add(const DeviceCosts& costs, const LeastBytes& bytes, DeviceTimes& times) {
  times.upload.add(costs.upload_ms);
  times.fuse.add(costs.fuse_ms);
  times.layers.add(costs.layers_ms);
  times.download.add(costs.download_ms);
  times.launches = std::max(times.launches, costs.launches);
  times.bytes_up += static_cast<double>(costs.bytes_up);
  times.bytes_down += static_cast<double>(costs.bytes_down);
  times.least_bytes = times.least_bytes + bytes;
}

// Sums become means.
void divide(double ticks, TickTimes& times) {
  times.bricks_entering /= ticks;
  if (!times.device) return;
  times.device->bytes_up /= ticks;
  times.device->bytes_down /= ticks;
  times.device->least_bytes = times.device->least_bytes / ticks;
}

// A back end that drives, from its first tick on.
class Driver {
 public:
  Driver(FusionBackend& backend, const LayerArrays& layers) : backend_(backend), layers_(layers) {}

  // One tick; its times go to `times`.
  DeviceExpected<void> run(const WindowMap& map, TickTimes& times) {
    DeviceExpected<AddResult> added;
    const double fuse_ms = time_ms([&] { added = backend_.add(map); });
    if (!added) return tl::make_unexpected(added.error());
    if (*added != AddResult::added) return tl::make_unexpected(DeviceError{"the window refused a map"});
    DeviceExpected<void> made;
    const double layers_ms = time_ms([&] { made = backend_.make_layers(layers_); });
    if (!made) return made;
    times.fuse.add(fuse_ms);
    times.layers.add(layers_ms);
    times.both.add(fuse_ms + layers_ms);
    const Grid before = std::exchange(grid_, map.view.grid);
    times.bricks_entering += bricks_entering(grid_, before);
    if (const auto costs = backend_.last_costs()) {
      if (!times.device) times.device.emplace();
      add(*costs, least_bytes(backend_.window(), before, layers_), *times.device);
    }
    for (const KernelTime& kernel : backend_.take_kernel_times()) times.kernels.add(kernel.name, kernel.ms);
    return {};
  }

 private:
  FusionBackend& backend_;
  const LayerArrays& layers_;
  Grid grid_;
};

}  // namespace

DeviceExpected<TickTimes> measure_ticks(Backend which, const Drive& drive, const Stretch& stretch,
                                        const std::vector<int>& kept_ticks, Kernels kernels) {
  DriveMemory memory(drive);
  auto opened = open_fusion(which, setup_of(drive, memory.whole(), kernels));
  if (!opened) return tl::make_unexpected(opened.error());
  const LayerArrays layers = layer_arrays(memory.layers(), drive.columns());
  Driver driver(*opened->backend, layers);
  TickTimes warm_up;
  TickTimes times;
  for (int tick = stretch.begin - ticks_before(drive); tick < stretch.end; ++tick) {
    const BrickMapView view = drive.copy_map_of_tick(tick, memory.map_of_tick(tick));
    const WindowMap map{view, 0, static_cast<std::uint64_t>(tick)};
    const auto done = driver.run(map, tick < stretch.begin ? warm_up : times);
    if (!done) return tl::make_unexpected(done.error());
    if (std::find(kept_ticks.begin(), kept_ticks.end(), tick) != kept_ticks.end())
      times.kept.push_back({tick, {memory.layers(), memory.layers() + memory.layers_bytes()}});
  }
  divide(stretch.end - stretch.begin, times);
  if (times.device) times.device->details = opened->details;
  return times;
}

}  // namespace gvom::bench
