#include "tools/benchmark/drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/memory.hpp"

namespace gvom::bench {

namespace {

constexpr std::int64_t kTick_ns = 100'000'000;
constexpr int kWarmUpTicks = 10;  // with a full window

std::size_t most_map_bytes(const std::vector<OwnedMap>& maps) {
  std::size_t most = 0;
  for (const OwnedMap& map : maps) most = std::max(most, map.view.bytes_in_one);
  return most;
}

// So many ticks after a map has left the window nothing of it is remembered any more (R17): rays are longest.
int ticks_remembered(const MemoryConfig& memory) {
  const std::int32_t beats = beats_remembered(memory.max_age_s);
  if (beats == 0) return 0;
  const std::int64_t rays_ns = std::int64_t{kSpans * beats_of_span(beats)} << kBeatBits;
  return static_cast<int>(rays_ns / kTick_ns) + 1;
}

}  // namespace

Int3 Drive::lap() const {
  Int3 voxels{};
  const double brick_m = kBrickEdge * map.resolution_xy_m;
  for (std::size_t a = 0; a < 2; ++a)
    voxels[a] = kBrickEdge * static_cast<std::int32_t>(
                                 std::lround(recording.lap_m[static_cast<Eigen::Index>(a)] / brick_m));
  return voxels;
}

const BrickMapView& Drive::map_of_tick(int tick) const {
  return maps[static_cast<std::size_t>(tick) % maps.size()].view;
}

BrickMapView Drive::copy_map_of_tick(int tick, std::byte* begin) const {
  BrickMapView view = copy_map(map_of_tick(tick), begin);
  view.stamp_ns = tick * kTick_ns;
  const Int3 one_lap = lap();
  const int laps = tick / static_cast<int>(maps.size());
  for (std::size_t a = 0; a < 2; ++a) {
    view.grid.origin[a] += laps * one_lap[a];
    view.T_odom_base.position_m[a] += laps * one_lap[a] * map.resolution_xy_m;
  }
  return view;
}

int ticks_before(const Drive& drive) {
  return drive.window + ticks_remembered(drive.memory) + kWarmUpTicks;
}

std::uint32_t bricks_entering(const Grid& grid, const Grid& before) {
  const Int3 n = grid.bricks();
  std::int64_t stay = 1;
  for (std::size_t a = 0; a < 3; ++a)
    stay *= std::max(0, n[a] - std::abs(grid.origin[a] - before.origin[a]) / kBrickEdge);
  return grid.brick_slots() - static_cast<std::uint32_t>(stay);
}

DriveMemory::DriveMemory(const Drive& drive)
    : layers_bytes_(bench::layers_bytes(drive.columns())),
      most_map_bytes_(most_map_bytes(drive.maps)),
      places_(static_cast<std::size_t>(drive.window) + 2),
      memory_(layers_bytes_ + places_ * most_map_bytes_) {}

}  // namespace gvom::bench
