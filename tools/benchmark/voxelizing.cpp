#include "core/open_backend.hpp"
#include "tools/benchmark/measure.hpp"

namespace gvom::bench {

namespace {

constexpr std::size_t kMostReturns = 262144;

OwnedMap copy_of(const BrickMapView& map) {
  OwnedMap copy{Memory(map.bytes_in_one), {}};
  copy.view = copy_map(map, copy.memory.begin());
  return copy;
}

}  // namespace

DeviceExpected<VoxelizingTimes> measure_voxelizing(Backend which, const MapConfig& config,
                                                   const Recording& recording, std::size_t runs,
                                                   Kernels kernels) {
  const Grid shape_of_grid = grid_around(config, Eigen::Vector3d::Zero());
  const std::uint32_t slots = shape_of_grid.brick_slots();
  Memory out(map_bytes({slots, slots, static_cast<std::uint32_t>(kMostReturns), shape_of_grid.columns()}));
  auto opened = open_voxelizer(
      which, {config, recording.lidar, {}, kMostReturns, out.whole(), kernels == Kernels::timed});
  if (!opened) return tl::make_unexpected(opened.error());
  VoxelizerBackend& voxelizer = *opened->backend;
  VoxelizingTimes times;
  times.details = opened->details;
  for (std::size_t run = 0; run < runs; ++run) {
    const std::size_t i = run % recording.sweeps.size();
    const Sweep& sweep = recording.sweeps[i];
    const Pose& pose = recording.T_odom_base[i];
    const Grid grid = grid_around(config, pose.translation_m);
    const std::vector<Pose> poses(sweep.times_ns.size(), pose);
    DeviceExpected<BrickMapShape> shape;
    const double count_ms = time_ms([&] { shape = voxelizer.count(sweep, poses, grid); });
    if (!shape) return tl::make_unexpected(shape.error());
    const BrickMapArrays arrays = map_arrays(out.begin(), *shape);
    DeviceExpected<void> written;
    const double write_ms = time_ms([&] { written = voxelizer.write(arrays); });
    if (!written) return tl::make_unexpected(written.error());
    times.count.add(count_ms);
    times.write.add(write_ms);
    times.both.add(count_ms + write_ms);
    for (const KernelTime& kernel : voxelizer.take_kernel_times()) times.kernels.add(kernel.name, kernel.ms);
    if (run == i) times.maps.push_back(copy_of(map_in_one({grid, 0, record_of(pose), *shape}, arrays)));
  }
  return times;
}

}  // namespace gvom::bench
