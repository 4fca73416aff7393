#include "tools/drive/pictures/course_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gvom::driving {

CourseMap::CourseMap(const Eigen::Vector2d& low_m, double edge_m, double cell_m) {
  const int n = static_cast<int>(std::ceil(edge_m / cell_m)) + 1;
  grid_.resolution_m[0] = grid_.resolution_m[1] = cell_m;
  for (int axis = 0; axis < 2; ++axis) {
    grid_.origin[axis] = static_cast<int>(std::floor(low_m[axis] / cell_m));
    grid_.size[axis] = n;
  }
  const std::size_t columns = static_cast<std::size_t>(n) * n;
  for (auto* layer : {&height_, &slope_, &roughness_})
    layer->assign(columns, std::numeric_limits<float>::quiet_NaN());
  clearance_.assign(columns, std::numeric_limits<float>::infinity());
  flags_.assign(columns, 0);
  visibility_.assign(columns, 0);
  looks_.resize(columns);
}

/// @return the flags that more than half of the looks had
std::uint8_t CourseMap::Looks::add(std::uint8_t flags) {
  ++all;
  std::uint8_t most = 0;
  for (unsigned bit = 0; bit < with.size(); ++bit) {
    with[bit] = static_cast<std::uint16_t>(with[bit] + (flags >> bit & 1));
    if (2 * with[bit] > all) most = static_cast<std::uint8_t>(most | 1U << bit);
  }
  return most;
}

void CourseMap::add(const Seen& seen) {
  const Grid& grid = seen.grid;
  const int n = grid_.size[0];
  for (int y = 0; y < grid.size[1]; ++y)
    for (int x = 0; x < grid.size[0]; ++x) {
      const std::size_t from = static_cast<std::size_t>(y) * grid.size[0] + x;
      const std::uint8_t visibility = seen.layers.visibility[from];
      if (visibility < static_cast<std::uint8_t>(Visibility::ground_seen) || is_remembered(visibility))
        continue;
      const int to_x = grid.origin[0] + x - grid_.origin[0], to_y = grid.origin[1] + y - grid_.origin[1];
      if (to_x < 0 || to_y < 0 || to_x >= n || to_y >= n) continue;
      const std::size_t to = static_cast<std::size_t>(to_y) * n + to_x;
      height_[to] = seen.layers.height[from];
      slope_[to] = seen.layers.slope[from];
      roughness_[to] = seen.layers.roughness[from];
      clearance_[to] = seen.layers.clearance[from];
      flags_[to] = looks_[to].add(seen.layers.flags[from]);
      visibility_[to] = visibility;
    }
}

planner::MapView CourseMap::view() const {
  return {0,
          grid_,
          height_.data(),
          slope_.data(),
          roughness_.data(),
          clearance_.data(),
          flags_.data(),
          visibility_.data()};
}

}  // namespace gvom::driving
