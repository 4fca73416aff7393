#include "tests/oracle/fusion.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace gvom::oracle {

namespace {

bool is_newer(const BufferMap* a, const BufferMap* b) {
  return a->stamp_ns != b->stamp_ns ? a->stamp_ns > b->stamp_ns : a->lidar < b->lidar;
}

}  // namespace

bool Fusion::add(const BufferMap& map) {
  for (const BufferMap& other : maps_)
    if (other.lidar == map.lidar && other.stamp_ns == map.stamp_ns) return false;
  std::vector<BufferMap> left;
  if (!maps_.empty())
    for (const BufferMap* one : window()) left.push_back(*one);
  maps_.push_back(map);
  const std::vector<const BufferMap*> maps = window();
  if (std::find(maps.begin(), maps.end(), &maps_.back()) == maps.end()) return false;
  const auto stayed = [&](const BufferMap& one) {
    return std::any_of(maps.begin(), maps.end(), [&](const BufferMap* other) {
      return other->lidar == one.lidar && other->stamp_ns == one.stamp_ns;
    });
  };
  left.erase(std::remove_if(left.begin(), left.end(), stayed), left.end());
  memory_.step(maps.front()->grid, maps.front()->stamp_ns, left);
  return true;
}

std::vector<const BufferMap*> Fusion::window() const {
  std::vector<const BufferMap*> all;
  for (const BufferMap& map : maps_) all.push_back(&map);
  std::sort(all.begin(), all.end(), is_newer);
  const std::int64_t max_age_ns = std::llround(config_.max_age_s * 1e9);
  std::map<int, int> of_lidar;
  std::vector<const BufferMap*> window;
  for (const BufferMap* map : all)
    if (all.front()->stamp_ns - map->stamp_ns <= max_age_ns && of_lidar[map->lidar]++ < config_.buffer_size)
      window.push_back(map);
  return window;
}

VoxelBox Fusion::voxels() const {
  const std::vector<const BufferMap*> maps = window();
  VoxelBox sum(maps.front()->grid);
  for (const BufferMap* map : maps)
    for (const WorldVoxel& one : map->observed) {
      if (!sum.holds(one.at)) continue;
      Voxel& voxel = sum[one.at];
      voxel.hits += one.voxel.hits;
      voxel.passes += one.voxel.passes;
      voxel.min_height_m = std::min(voxel.min_height_m, one.voxel.min_height_m);
    }
  return sum;
}

ColumnHeights Fusion::remembered_ray() const {
  ColumnHeights none(window().front()->grid);
  return memory_.on() ? memory_.lowest_ray() : none;
}

VoxelBox Fusion::shown_voxels() const {
  VoxelBox shown = voxels();
  memory_.add_to(shown);
  return shown;
}

ColumnHeights Fusion::lowest_ray() const {
  const std::vector<const BufferMap*> maps = window();
  const Grid& grid = maps.front()->grid;
  ColumnHeights lowest(grid);
  for (const BufferMap* map : maps) {
    ColumnHeights of_map = map->lowest_ray;
    for (std::int64_t y = 0; y < grid.size[1]; ++y)
      for (std::int64_t x = 0; x < grid.size[0]; ++x) {
        const float* const height_m =
            of_map.at(x + grid.origin[0] - map->grid.origin[0], y + grid.origin[1] - map->grid.origin[1]);
        if (height_m != nullptr) *lowest.at(x, y) = std::min(*lowest.at(x, y), *height_m);
      }
  }
  return lowest;
}

}  // namespace gvom::oracle
