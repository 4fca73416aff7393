#include "tools/benchmark/gpu.hpp"

#include "tools/benchmark/text.hpp"
#include "tools/compare/maps.hpp"

namespace gvom::bench {

namespace {

constexpr int kComparedTicks = 4;

struct Plan {
  std::vector<MapConfig> grids;
  std::vector<int> windows;
  int kernels_window;  // at which each kernel is timed
};

Plan plan_of(const GpuSetting& setting) {
  const auto grid = [](int size_xy, int size_z) {
    MapConfig config;
    config.size_xy = size_xy;
    config.size_z = size_z;
    return config;
  };
  if (setting.quick) return {{grid(64, 32)}, {2}, 2};
  Plan plan{{grid(256, 64), grid(512, 128)}, {1, 8, 32, 128}, 32};
  plan.grids.resize(std::min(plan.grids.size(), static_cast<std::size_t>(setting.grids)));
  return plan;
}

tl::unexpected<Failure> unavailable(const DeviceError& error) {
  return tl::make_unexpected(Failure(error));
}

tl::unexpected<Failure> differ(const std::string& what, const std::string& difference) {
  return tl::make_unexpected(Failure("the back ends' " + what + " differ\n" + difference));
}

tl::expected<void, Failure> voxelize(const Recording& recording, int repeats, GpuComparison& result) {
  const std::size_t sweeps = recording.sweeps.size();
  const auto runs = [&](int of_a_repeat) {
    return std::max(sweeps, static_cast<std::size_t>(of_a_repeat) * static_cast<std::size_t>(repeats));
  };
  auto cpu = measure_voxelizing(Backend::cpu, result.voxelized, recording, runs(kHostRuns));
  if (!cpu) return unavailable(cpu.error());
  auto cuda = measure_voxelizing(Backend::cuda, result.voxelized, recording, runs(kDeviceRuns));
  if (!cuda) return unavailable(cuda.error());
  for (std::size_t i = 0; i < sweeps; ++i)
    if (const auto words = compare::map_difference(cpu->maps[i].view, cuda->maps[i].view); !words.empty())
      return differ(text("buffer maps of sweep %zu", i), words);
  result.cpu_voxelizing = std::move(*cpu);
  result.cuda_voxelizing = std::move(*cuda);
  return {};
}

// Empty if both have the same layers.
std::string kept_difference(const Drive& drive, std::vector<KeptLayers>& expected,
                            std::vector<KeptLayers>& found) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto words =
        compare::layers_difference(layer_arrays(expected[i].bytes.data(), drive.columns()),
                                   layer_arrays(found[i].bytes.data(), drive.columns()), drive.map.size_xy);
    if (!words.empty()) return text("after tick %d:\n", expected[i].tick) + words;
  }
  return {};
}

// The CPU is slower and drives only the last part, which gives the same layers: they are those of the
// window's maps, and of what is remembered of the maps before.
tl::expected<TickRow, Failure> fuse(const Drive& drive, int repeats) {
  const int begin = ticks_before(drive), end = begin + kDeviceRuns * repeats;
  const int host_ticks = kHostRuns * repeats;
  std::vector<int> kept;
  for (int i = 0; i < kComparedTicks; ++i) kept.push_back(end - 1 - i * host_ticks / kComparedTicks);
  auto cpu = measure_ticks(Backend::cpu, drive, {end - host_ticks, end}, kept);
  if (!cpu) return unavailable(cpu.error());
  auto cuda = measure_ticks(Backend::cuda, drive, {begin, end}, kept);
  if (!cuda) {
    if (cuda.error().what.find("out of memory") == std::string::npos) return unavailable(cuda.error());
    return TickRow{drive.map, drive.window, std::move(*cpu), tl::make_unexpected(cuda.error().what)};
  }
  if (const auto words = kept_difference(drive, cpu->kept, cuda->kept); !words.empty())
    return differ(text("layers of %s voxels, window %d,", name_of(drive.map).c_str(), drive.window), words);
  cpu->kept.clear();
  cuda->kept.clear();
  return TickRow{drive.map, drive.window, std::move(*cpu), std::move(*cuda)};
}

tl::expected<void, Failure> time_sweep_kernels(const Recording& recording, GpuComparison& result) {
  const auto timed =
      measure_voxelizing(Backend::cuda, result.voxelized, recording, recording.sweeps.size(), Kernels::timed);
  if (!timed) return unavailable(timed.error());
  result.kernels.push_back({"a sweep, " + name_of(result.voxelized), timed->kernels});
  return {};
}

tl::expected<void, Failure> time_tick_kernels(const Drive& drive, int repeats, GpuComparison& result) {
  const int begin = ticks_before(drive);
  const auto timed =
      measure_ticks(Backend::cuda, drive, {begin, begin + kKernelRuns * repeats}, {}, Kernels::timed);
  if (!timed) return unavailable(timed.error());
  result.kernels.push_back(
      {text("a tick, %s, window %d", name_of(drive.map).c_str(), drive.window), timed->kernels});
  return {};
}

}  // namespace

std::string name_of(const MapConfig& grid) {
  return text("%d x %d x %d", grid.size_xy, grid.size_xy, grid.size_z);
}

tl::expected<GpuComparison, Failure> compare_with_gpu(const Recording& recording, const GpuSetting& setting) {
  const auto rates = cuda::measure_copies();
  if (!rates) return unavailable(rates.error());
  const Plan plan = plan_of(setting);
  GpuComparison result{*rates, plan.grids.front(), {}, {}, {}, {}};
  if (const auto done = voxelize(recording, setting.repeats, result); !done)
    return tl::make_unexpected(done.error());
  if (const auto done = time_sweep_kernels(recording, result); !done)
    return tl::make_unexpected(done.error());
  for (const MapConfig& grid : plan.grids) {
    const auto voxelized = measure_voxelizing(Backend::cpu, grid, recording, recording.sweeps.size());
    if (!voxelized) return unavailable(voxelized.error());
    for (const int window : plan.windows) {
      const Drive drive{recording, voxelized->maps, grid, window};
      auto row = fuse(drive, setting.repeats);
      if (!row) return tl::make_unexpected(row.error());
      const bool fits = row->cuda.has_value();
      result.rows.push_back(std::move(*row));
      if (window != plan.kernels_window || !fits) continue;
      if (const auto done = time_tick_kernels(drive, setting.repeats, result); !done)
        return tl::make_unexpected(done.error());
    }
  }
  return result;
}

}  // namespace gvom::bench
