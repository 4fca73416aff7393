// A map of nothing but a lidar and a time, for tests of what a window makes of these.
#pragma once

#include <cstdint>

#include "core/grid.hpp"
#include "core/window.hpp"

namespace gvom::test {

inline WindowMap map(int lidar, std::int64_t stamp_ns) {
  WindowMap map;
  map.view.grid = grid_around({}, Eigen::Vector3d::Zero());
  map.view.stamp_ns = stamp_ns;
  map.lidar = lidar;
  return map;
}

}  // namespace gvom::test
