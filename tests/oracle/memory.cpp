#include "tests/oracle/memory.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace gvom::oracle {

namespace {

constexpr std::int64_t kBeat_ns = 1 << 29;

std::int64_t floor_of_quotient(std::int64_t a, std::int64_t b) {
  const std::int64_t rest = ((a % b) + b) % b;
  return (a - rest) / b;
}

int brick_of(int voxel) {
  return static_cast<int>(floor_of_quotient(voxel, 8));
}

// All but the passes of the lowest voxel of each column, if that was not hit.
std::vector<WorldVoxel> telling_of(const BufferMap& map) {
  std::map<std::pair<int, int>, int> lowest;
  for (const WorldVoxel& one : map.observed) {
    const auto column = lowest.emplace(std::make_pair(one.at[0], one.at[1]), one.at[2]).first;
    column->second = std::min(column->second, one.at[2]);
  }
  std::vector<WorldVoxel> telling;
  for (const WorldVoxel& one : map.observed)
    if (one.voxel.hits > 0 || one.at[2] > lowest[{one.at[0], one.at[1]}]) telling.push_back(one);
  return telling;
}

// The voxels of a sum over the maps of one beat.
struct Sum {
  std::int64_t beat = INT64_MIN;
  std::uint64_t hits = 0, passes_with_hits = 0, passes = 0;
  float min_height_m = std::numeric_limits<float>::infinity();
};

}  // namespace

Memory::Memory(const MemoryConfig& config)
    : beats_(static_cast<std::int64_t>(std::ceil(config.max_age_s * 1e9 / kBeat_ns))) {}

void Memory::step(const Grid& grid, std::int64_t newest_ns, const std::vector<BufferMap>& left) {
  if (beats_ == 0) return;
  ++steps_;
  grid_ = grid;
  now_ = floor_of_quotient(newest_ns, kBeat_ns);
  const Int3 low{brick_of(grid.origin[0]), brick_of(grid.origin[1]), brick_of(grid.origin[2])};
  std::map<Int3, std::int64_t> bricks;
  std::map<std::pair<int, int>, std::int64_t> stacks;
  for (int x = low[0]; x < low[0] + grid.size[0] / 8; ++x)
    for (int y = low[1]; y < low[1] + grid.size[1] / 8; ++y) {
      stacks[{x, y}] = stacks_.count({x, y}) > 0 ? stacks_[{x, y}] : steps_;
      for (int z = low[2]; z < low[2] + grid.size[2] / 8; ++z)
        bricks[{x, y, z}] = bricks_.count({x, y, z}) > 0 ? bricks_[{x, y, z}] : steps_;
    }
  bricks_ = bricks;
  stacks_ = stacks;
  for (const BufferMap& map : left)
    gone_.push_back({steps_, floor_of_quotient(map.stamp_ns, kBeat_ns), map, telling_of(map)});
  // Of no more use: time only goes on.
  const auto is_past = [&](const Gone& gone) { return now_ - gone.beat > 3 * beats_ + 10; };
  gone_.erase(std::remove_if(gone_.begin(), gone_.end(), is_past), gone_.end());
}

void Memory::add_to(VoxelBox& voxels) const {
  std::map<Int3, Sum> sums;
  for (const Gone& gone : gone_)
    for (const WorldVoxel& one : gone.telling) {
      if (too_old(gone.beat) || !voxels.holds(one.at) || voxels[one.at].hits > 0) continue;
      if (gone.step < bricks_.at({brick_of(one.at[0]), brick_of(one.at[1]), brick_of(one.at[2])})) continue;
      Sum& sum = sums[one.at];
      if (gone.beat < sum.beat) continue;
      if (gone.beat > sum.beat) sum = {gone.beat};
      sum.hits += one.voxel.hits;
      (one.voxel.hits > 0 ? sum.passes_with_hits : sum.passes) += one.voxel.passes;
      sum.min_height_m = std::min(sum.min_height_m, one.voxel.min_height_m);
    }
  for (const auto& [at, sum] : sums) {
    Voxel& voxel = voxels[at];
    voxel.told_hits = static_cast<std::uint32_t>(std::min<std::uint64_t>(sum.hits, 4095));
    voxel.told_height_m = sum.min_height_m;
    voxel.beat = sum.beat;
    if (voxel.observed()) continue;
    voxel.hits = static_cast<std::uint32_t>(std::min<std::uint64_t>(sum.hits, 4095));
    voxel.passes = static_cast<std::uint32_t>(std::min<std::uint64_t>(sum.passes_with_hits, 4095) +
                                              std::min<std::uint64_t>(sum.passes, 255));
    voxel.min_height_m = sum.min_height_m;
    voxel.remembered = true;
  }
}

ColumnHeights Memory::lowest_ray() const {
  ColumnHeights lowest(grid_);
  const std::int64_t span = (beats_ + 3) / 4;
  for (const Gone& gone : gone_) {
    if (floor_of_quotient(now_, span) - floor_of_quotient(gone.beat, span) > 4) continue;
    const Grid& grid = gone.map.grid;
    ColumnHeights rays = gone.map.lowest_ray;
    for (int y = 0; y < grid_.size[1]; ++y)
      for (int x = 0; x < grid_.size[0]; ++x) {
        if (gone.step < stacks_.at({brick_of(grid_.origin[0] + x), brick_of(grid_.origin[1] + y)})) continue;
        const float* const ray_m = rays.at(std::int64_t{x} + grid_.origin[0] - gone.map.grid.origin[0],
                                           std::int64_t{y} + grid_.origin[1] - gone.map.grid.origin[1]);
        if (ray_m == nullptr) continue;
        const double east = brick_of(grid_.origin[0] + x) - grid.origin[0] / 8 + 0.5 - grid.size[0] / 16.0;
        const double north = brick_of(grid_.origin[1] + y) - grid.origin[1] / 8 + 0.5 - grid.size[1] / 16.0;
        const double range_m = 8 * grid.resolution_m[0] * std::sqrt(east * east + north * north);
        *lowest.at(x, y) = std::min(*lowest.at(x, y), *ray_m + static_cast<float>(0.004 * range_m));
      }
  }
  return lowest;
}

std::vector<std::int64_t> Memory::column_beats() const {
  std::vector<std::int64_t> beats(std::size_t(grid_.size[0]) * std::size_t(grid_.size[1]), INT64_MIN);
  for (const Gone& gone : gone_)
    for (const WorldVoxel& one : gone.map.observed) {
      const std::int64_t x = std::int64_t{one.at[0]} - grid_.origin[0];
      const std::int64_t y = std::int64_t{one.at[1]} - grid_.origin[1];
      if (x < 0 || y < 0 || x >= grid_.size[0] || y >= grid_.size[1]) continue;
      if (gone.step < stacks_.at({brick_of(one.at[0]), brick_of(one.at[1])})) continue;
      std::int64_t& beat = beats[std::size_t(y) * std::size_t(grid_.size[0]) + std::size_t(x)];
      beat = std::max(beat, gone.beat);
    }
  return beats;
}

}  // namespace gvom::oracle
