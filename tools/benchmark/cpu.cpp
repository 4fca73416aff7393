#include "tools/benchmark/cpu.hpp"

#include <cstdio>

#include "tools/benchmark/measure.hpp"

namespace gvom::bench {

namespace {

constexpr int kWindows[] = {1, 8, 32, 128};

void add_ingest(const VoxelizingTimes& times, const StraightTimes& straight, Report& report) {
  report.passes_per_sweep = static_cast<double>(straight.passes) / static_cast<double>(report.setting.sweeps);
  report.ns_per_pass = times.both.quantile_ms(0.5) * 1e6 / report.passes_per_sweep;
  report.add("ingest: count", times.count);
  report.add("ingest: write", times.write);
  report.add("ingest", times.both);
  report.add("straight loop over the exact walk", straight.times, "ingest");
}

void add_octomap([[maybe_unused]] const Recording& recording, [[maybe_unused]] Report& report) {
#ifdef GVOM_OCTOMAP
  const OctomapTimes times = measure_octomap(recording, 2);
  report.add("OctoMap", times.every_ray, "ingest");
  report.add("OctoMap, discretized", times.discretized, "ingest");
#else
  std::fputs("gvom-bench: built without OctoMap\n", stderr);
#endif
}

void add_ticks(int window, const TickTimes& times, Report& report) {
  const std::string name = "window " + std::to_string(window);
  report.add(name + ": fuse", times.fuse);
  report.add(name + ": layers", times.layers);
  report.add(name + ": fuse and layers", times.both, "window 1: fuse and layers");
}

}  // namespace

tl::expected<Report, Failure> measure_cpu(const Setting& setting, const Recording& recording,
                                          const CpuSetting& of) {
  const MapConfig config;
  const auto voxelized = measure_voxelizing(Backend::cpu, config, recording,
                                            static_cast<std::size_t>(of.repeats) * recording.sweeps.size());
  if (!voxelized) return tl::make_unexpected(Failure(voxelized.error()));
  const auto straight = measure_straight(config, recording, voxelized->maps, (of.repeats + 9) / 10);
  if (!straight.agree) return tl::make_unexpected(Failure("passes differ from the straight loop's"));
  Report report{setting, 0, 0, {}};
  add_ingest(*voxelized, straight, report);
  if (of.octomap) add_octomap(recording, report);
  for (const int window : kWindows) {
    const Drive drive{recording, voxelized->maps, config, window, of.memory};
    const int first = ticks_before(drive);
    const auto times = measure_ticks(Backend::cpu, drive, {first, first + 10 * of.repeats});
    if (!times) return tl::make_unexpected(Failure(times.error()));
    add_ticks(window, *times, report);
  }
  return report;
}

}  // namespace gvom::bench
