#include "tools/benchmark/gpu_report.hpp"
#include "tools/benchmark/gpu_stages.hpp"
#include "tools/benchmark/gpu_words.hpp"
#include "tools/benchmark/text.hpp"

namespace gvom::bench {

namespace {

const std::string& device_name(const GpuComparison& comparison) {
  return comparison.cuda_voxelizing.details;
}

std::string heading(const Setting& setting, const GpuComparison& comparison) {
  const cuda::CopyRates& rates = comparison.rates;
  return text("- GPU: %s\n", device_name(comparison).c_str()) +
         text("- copies: %.1f GB/s from pinned memory, %.1f GB/s to it, %.0f GB/s within (read plus write)\n",
              rates.to_device * 1e-9, rates.to_host * 1e-9, rates.within_device * 1e-9) +
         text("- CPU: %s; one thread\n", setting.machine.c_str()) +
         text("- input: %s; %zu sweeps, each on average %.0f returns\n", setting.recording.c_str(),
              setting.sweeps, setting.returns_per_sweep) +
         text("- command: `%s`\n\n", setting.command.c_str());
}

std::string place(const TickRow& row) {
  return text("| %s | %d |", name_of(row.map).c_str(), row.window);
}

std::string tick_table(const GpuComparison& comparison) {
  std::string all =
      "A tick, ms, p50 / p99: a new map in pinned memory to layers in pinned memory, on a grid that moves. "
      "Whole ticks by the host's clock, the GPU's stages by its own; both back ends' layers were the same "
      "bytes.\n\n"
      "| grid | window | bricks entering | GPU tick | upload | fuse | layers | download | launches "
      "| CPU tick | fuse | layers | CPU / GPU |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const TickRow& row : comparison.rows) {
    const DeviceTimes* device = device_of(row);
    all += place(row) + text(" %.0f |", row.bricks_entering());
    if (device == nullptr)
      all += text(" does not fit: %s | | | | | |", row.cuda.error().c_str());
    else
      all += text(" %s | %s | %s | %s | %s | %llu |", times(row.cuda->both).c_str(),
                  times(device->upload).c_str(), times(device->fuse).c_str(), times(device->layers).c_str(),
                  times(device->download).c_str(), static_cast<unsigned long long>(device->launches));
    all += text(" %s | %s | %s |", times(row.cpu.both).c_str(), times(row.cpu.fuse).c_str(),
                times(row.cpu.layers).c_str());
    all += device == nullptr ? " |\n" : text(" %.1f |\n", ratio(row.cpu.both, row.cuda->both));
  }
  return all + "\n";
}

std::string bytes_table(const GpuComparison& comparison) {
  std::string all = text(
      "The fewest bytes that a stage must move, how long that takes at the copy rate (upload and download: "
      "from and to pinned memory; fuse and layers: within the device), and the share of this rate that its "
      "median reaches with them; over 100 %% is the doing of caches.\n\n%s\n"
      "| grid | window | stage | ms, p50 / p99 | MB | floor, ms | share |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n",
      kLeastBytesWords);
  for (const TickRow& row : comparison.rows) {
    const DeviceTimes* device = device_of(row);
    if (device == nullptr) continue;
    for (const Stage& stage : stages_of(*device, comparison.rates))
      all += place(row) + text(" %s | %s | %.2f | %.3f | %.0f %% |\n", stage.name, times(stage.times).c_str(),
                               stage.least_bytes * 1e-6, stage.least_ms(), 100 * stage.share());
  }
  return all + "\n";
}

std::string voxelizing_table(const GpuComparison& comparison) {
  const VoxelizingTimes& cpu = comparison.cpu_voxelizing;
  const VoxelizingTimes& cuda = comparison.cuda_voxelizing;
  std::string all = text(
      "A sweep to its buffer map, %s, ms, p50 / p99, by the host's clock; the maps were the same bytes.\n\n"
      "| | count | write | both |\n| --- | --- | --- | --- |\n",
      name_of(comparison.voxelized).c_str());
  for (const auto& [name, side] : {std::pair("GPU", &cuda), std::pair("CPU", &cpu)})
    all += text("| %s | %s | %s | %s |\n", name, times(side->count).c_str(), times(side->write).c_str(),
                times(side->both).c_str());
  return all + text("| CPU / GPU | %.1f | %.1f | %.1f |\n", ratio(cpu.count, cuda.count),
                    ratio(cpu.write, cuda.write), ratio(cpu.both, cuda.both));
}

std::string kernel_tables(const GpuComparison& comparison) {
  std::string all;
  for (const KernelTable& table : comparison.kernels) {
    all += text(
        "\nEach kernel of %s, by events around it, ms, p50 / p99. Together they take less: they are not "
        "played as one graph here. CastReturn is timed for each batch of returns.\n\n| kernel | ms | times "
        "|\n| --- | --- | --- |\n",
        table.of.c_str());
    for (const NamedSamples::Step& step : table.kernels.steps())
      all += text("| %s | %s | %zu |\n", step.name.c_str(), times(step.times).c_str(), step.times.size());
  }
  return all;
}

// Rows whose device says something else than the heading.
std::string notes(const GpuComparison& comparison) {
  std::string all;
  for (const TickRow& row : comparison.rows) {
    const DeviceTimes* device = device_of(row);
    if (device != nullptr && device->details != device_name(comparison))
      all += text("%s, window %d: %s\n\n", name_of(row.map).c_str(), row.window, device->details.c_str());
  }
  return all;
}

}  // namespace

std::string markdown(const Setting& setting, const GpuComparison& comparison) {
  return heading(setting, comparison) + tick_table(comparison) + notes(comparison) + bytes_table(comparison) +
         voxelizing_table(comparison) + kernel_tables(comparison);
}

}  // namespace gvom::bench
