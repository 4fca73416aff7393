// gvom-count-traffic: what the CUDA back end's kernels read and write in a tick, on the host. A table in
// Markdown.
//
// The drive is gvom-bench's: an OS1-128 in a street at 11.6 m/s, over bumps, so that bricks enter on all
// sides.
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "core/open_backend.hpp"
#include "tests/fake_cuda/counted/counter.hpp"
#include "tests/fake_cuda/fake_cuda.hpp"
#include "tools/benchmark/gpu.hpp"
#include "tools/benchmark/measure.hpp"

namespace gvom::bench {
namespace {

constexpr int kCounted = 32;  // ticks

struct Tally {
  double read_bytes = 0, written_bytes = 0;  // mean of the ticks
  double worst_bytes = 0;                    // of one tick, read and written
  std::uint64_t busiest_loads = 0;
};

struct Counted {
  std::vector<std::string> order;
  std::map<std::string, Tally> of;
  Tally all;
};

void add(const std::vector<fake_cuda::KernelTraffic>& kernels, Counted& counted) {
  double bytes = 0;
  for (const fake_cuda::KernelTraffic& kernel : kernels) {
    if (counted.of.count(kernel.name) == 0) counted.order.push_back(kernel.name);
    for (Tally* tally : {&counted.of[kernel.name], &counted.all}) {
      tally->read_bytes += static_cast<double>(kernel.read_bytes) / kCounted;
      tally->written_bytes += static_cast<double>(kernel.written_bytes) / kCounted;
      tally->busiest_loads = std::max(tally->busiest_loads, kernel.busiest_loads);
    }
    Tally& own = counted.of[kernel.name];
    const auto here = static_cast<double>(kernel.read_bytes + kernel.written_bytes);
    own.worst_bytes = std::max(own.worst_bytes, here);
    bytes += here;
  }
  counted.all.worst_bytes = std::max(counted.all.worst_bytes, bytes);
}

DeviceExpected<Counted> count(const Drive& drive) {
  DriveMemory memory(drive);
  MapperConfig config;
  config.map = drive.map;
  config.window = {drive.window, 3600};
  auto opened = open_fusion(Backend::cuda, {config, 1, 262'144, memory.whole()});
  if (!opened) return tl::make_unexpected(opened.error());
  const LayerArrays layers = layer_arrays(memory.layers(), drive.columns());
  Counted counted;
  const int first = ticks_before(drive);
  for (int tick = 0; tick < first + kCounted; ++tick) {
    const BrickMapView view = drive.copy_map_of_tick(tick, memory.map_of_tick(tick));
    if (tick >= first) fake_cuda::count_traffic();
    const auto added = opened->backend->add({view, 0, static_cast<std::uint64_t>(tick)});
    if (!added) return tl::make_unexpected(added.error());
    if (const auto made = opened->backend->make_layers(layers); !made)
      return tl::make_unexpected(made.error());
    if (tick >= first) add(fake_cuda::take_traffic(), counted);
  }
  return counted;
}

void print(const std::string& place, const std::string& kernel, const Tally& tally) {
  std::printf("| %s | %s | %.2f | %.2f | %.2f | %llu |\n", place.c_str(), kernel.c_str(),
              tally.read_bytes * 1e-6, tally.written_bytes * 1e-6, tally.worst_bytes * 1e-6,
              static_cast<unsigned long long>(tally.busiest_loads));
}

int run(bool whole) {
  const Recording recording = make_street(kStreetLidars[1]);
  std::printf(
      "| grid, window | kernel | MB read | MB written | MB, worst tick | loads, busiest thread |\n"
      "| --- | --- | --- | --- | --- | --- |\n");
  for (const auto& [size_xy, size_z] : {std::pair(256, 64), std::pair(512, 128)}) {
    MapConfig map;
    map.size_xy = size_xy;
    map.size_z = size_z;
    const auto voxelized = measure_voxelizing(Backend::cpu, map, recording, recording.sweeps.size());
    for (const int window : {1, 8, 32, 128}) {
      if (!whole && (window != 32 || size_xy != 256)) continue;
      const auto counted = count({recording, voxelized->maps, map, window});
      if (!counted) return std::fprintf(stderr, "%s\n", counted.error().what.c_str()), 1;
      const std::string place = name_of(map) + ", " + std::to_string(window);
      for (const std::string& kernel : counted->order)
        if (window == 32) print(place, kernel, counted->of.at(kernel));
      print(place, "all", counted->all);
    }
  }
  return 0;
}

}  // namespace
}  // namespace gvom::bench

int main(int count, char** values) {
  fake_cuda::set_multiprocessors(132);  // an H100's: so many bricks are updated at once
  return gvom::bench::run(count > 1 && std::string(values[1]) == "--whole");
}
