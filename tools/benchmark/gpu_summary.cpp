#include "tools/benchmark/gpu_report.hpp"
#include "tools/benchmark/gpu_stages.hpp"
#include "tools/benchmark/gpu_words.hpp"

namespace gvom::bench {

namespace {

std::string tick_line(const TickRow& row, const cuda::CopyRates& rates) {
  std::string line = text("%-16s %4d", name_of(row.map).c_str(), row.window);
  const DeviceTimes* device = device_of(row);
  if (device == nullptr) return line + text("  does not fit: %s\n", row.cuda.error().c_str());
  line += text(" %15s", times(row.cuda->both).c_str());
  for (const Stage& stage : stages_of(*device, rates)) line += text(" %7.3f", stage.times.quantile_ms(0.5));
  const double floor = floor_ms(*device, rates);
  line += text(" %7.3f %6.1f %5llu %5.1f %5.1f", floor, row.cuda->both.quantile_ms(0.5) / floor,
               static_cast<unsigned long long>(device->launches), device->bytes_up * 1e-6,
               device->bytes_down * 1e-6);
  return line + text(" %17s %7.1f %8.0f\n", times(row.cpu.both).c_str(), ratio(row.cpu.both, row.cuda->both),
                     row.bricks_entering());
}

// In microseconds.
std::string kernel_line(const KernelTable& table) {
  std::string line = table.of + ", kernels, us p50/p99:";
  for (const NamedSamples::Step& step : table.kernels.steps())
    line += text(" %s %.1f/%.1f", step.name.c_str(), 1e3 * step.times.quantile_ms(0.5),
                 1e3 * step.times.quantile_ms(0.99));
  return line + "\n";
}

}  // namespace

std::string summary(const Setting& setting, const GpuComparison& comparison) {
  const cuda::CopyRates& rates = comparison.rates;
  const VoxelizingTimes& cpu = comparison.cpu_voxelizing;
  const VoxelizingTimes& cuda = comparison.cuda_voxelizing;
  std::string all = text("%s: %zu sweeps of %.0f returns; ms, p50 / p99, p50 or mean\n",
                         setting.recording.c_str(), setting.sweeps, setting.returns_per_sweep);
  all += text("%-16s %4s %15s %7s %7s %7s %7s %7s %6s %5s %5s %5s %17s %7s %8s\n", "grid", "win.", "GPU tick",
              "upload", "fuse", "layers", "downl.", "floor", "x it", "kern.", "MB up", "down", "CPU tick",
              "CPU/GPU", "entering");
  for (const TickRow& row : comparison.rows) all += tick_line(row, rates);
  all += text("a sweep, %s: GPU %s (count %s), CPU %s: CPU/GPU %.1f\n", name_of(comparison.voxelized).c_str(),
              times(cuda.both).c_str(), times(cuda.count).c_str(), times(cpu.both).c_str(),
              ratio(cpu.both, cuda.both));
  for (const KernelTable& table : comparison.kernels) all += kernel_line(table);
  return all +
         text("copies: %.1f GB/s up, %.1f GB/s down, %.0f GB/s within; all bytes the same as the CPU's\n",
              rates.to_device * 1e-9, rates.to_host * 1e-9, rates.within_device * 1e-9);
}

}  // namespace gvom::bench
