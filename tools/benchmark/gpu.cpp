#include "tools/benchmark/gpu.hpp"

#include <cstring>

#include "tools/benchmark/text.hpp"

namespace gvom::bench {

namespace {

struct Plan {
  std::vector<MapConfig> grids;
  std::vector<int> windows;
};

Plan plan_of(bool quick) {
  const auto grid = [](int size_xy, int size_z) {
    MapConfig config;
    config.size_xy = size_xy;
    config.size_z = size_z;
    return config;
  };
  if (quick) return {{grid(64, 32)}, {2}};
  return {{grid(256, 64), grid(512, 64), grid(512, 128)}, {1, 8, 32, 128}};
}

tl::unexpected<Failure> unavailable(const DeviceError& error) {
  return tl::make_unexpected(Failure(error));
}

bool same_maps(const VoxelizingTimes& a, const VoxelizingTimes& b) {
  for (std::size_t i = 0; i < a.maps.size(); ++i) {
    const BrickMapView& one = a.maps[i].view;
    const BrickMapView& other = b.maps[i].view;
    if (one.shape.brick_count != other.shape.brick_count ||
        one.shape.record_count != other.shape.record_count ||
        std::memcmp(one.directory, other.directory, one.bytes_in_one) != 0)
      return false;
  }
  return true;
}

tl::expected<void, Failure> voxelize(const Recording& recording, int repeats, GpuComparison& result) {
  auto cpu = measure_voxelizing(Backend::cpu, result.voxelized, recording, repeats);
  if (!cpu) return unavailable(cpu.error());
  auto cuda = measure_voxelizing(Backend::cuda, result.voxelized, recording, repeats);
  if (!cuda) return unavailable(cuda.error());
  if (!same_maps(*cpu, *cuda)) return tl::make_unexpected(Failure("the back ends' buffer maps differ"));
  result.cpu_voxelizing = std::move(*cpu);
  result.cuda_voxelizing = std::move(*cuda);
  return {};
}

tl::expected<TickRow, Failure> fuse(const Drive& drive) {
  DriveMemory memory(drive);
  auto cpu = measure_ticks(Backend::cpu, drive, memory);
  if (!cpu) return unavailable(cpu.error());
  const std::vector<std::byte> layers(memory.layers(), memory.layers() + memory.layers_bytes());
  std::memset(memory.layers(), 0, memory.layers_bytes());
  auto cuda = measure_ticks(Backend::cuda, drive, memory);
  if (!cuda) {
    if (cuda.error().what.find("out of memory") == std::string::npos) return unavailable(cuda.error());
    return TickRow{drive.map, drive.window, std::move(*cpu), tl::make_unexpected(cuda.error().what)};
  }
  if (std::memcmp(memory.layers(), layers.data(), layers.size()) != 0)
    return tl::make_unexpected(Failure(
        text("the back ends' layers differ, grid %s, window %d", name_of(drive.map).c_str(), drive.window)));
  return TickRow{drive.map, drive.window, std::move(*cpu), std::move(*cuda)};
}

}  // namespace

std::string name_of(const MapConfig& grid) {
  return text("%d x %d x %d", grid.size_xy, grid.size_xy, grid.size_z);
}

tl::expected<GpuComparison, Failure> compare_with_gpu(const Recording& recording, int repeats, bool quick) {
  const auto rates = cuda::measure_copies();
  if (!rates) return unavailable(rates.error());
  const Plan plan = plan_of(quick);
  GpuComparison result{*rates, plan.grids.front(), {}, {}, {}};
  if (const auto done = voxelize(recording, repeats, result); !done) return tl::make_unexpected(done.error());
  for (const MapConfig& grid : plan.grids) {
    const auto voxelized = measure_voxelizing(Backend::cpu, grid, recording, 1);
    if (!voxelized) return unavailable(voxelized.error());
    for (const int window : plan.windows) {
      auto row = fuse({recording, voxelized->maps, grid, window, 10 * repeats});
      if (!row) return tl::make_unexpected(row.error());
      result.rows.push_back(std::move(*row));
    }
  }
  return result;
}

}  // namespace gvom::bench
