// The layers as the planner reads them, and places on their grid.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/format/grid.hpp"
#include "core/format/layers.hpp"
#include "core/pose.hpp"

namespace gvom::planner {

/// x, y and heading in odom.
struct Pose2 {
  double x_m = 0;
  double y_m = 0;
  double yaw_rad = 0;

  [[nodiscard]] Eigen::Vector2d place() const { return {x_m, y_m}; }
  [[nodiscard]] Eigen::Vector2d forward() const { return {std::cos(yaw_rad), std::sin(yaw_rad)}; }
};

/// Seen from above.
inline Pose2 flat(const Pose& pose) {
  const Eigen::Vector3d forward = pose.rotation * Eigen::Vector3d::UnitX();
  return {pose.translation_m.x(), pose.translation_m.y(), std::atan2(forward.y(), forward.x())};
}

/// The cells of a map by place: `n` * `n` of them, [y][x].
struct Cells {
  int n = 0;
  double cell_m = 1;
  double x_m = 0;  ///< The grid's lower corner in odom.
  double y_m = 0;

  [[nodiscard]] int count() const { return n * n; }
  [[nodiscard]] bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < n && y < n; }
  /// Of the cell that holds the point, or -1.
  [[nodiscard]] int index_of(double px_m, double py_m) const {
    const double x = std::floor((px_m - x_m) / cell_m), y = std::floor((py_m - y_m) / cell_m);
    if (!(x >= 0 && y >= 0 && x < n && y < n)) return -1;
    return static_cast<int>(y) * n + static_cast<int>(x);
  }
  [[nodiscard]] Eigen::Vector2d center_of(int index) const {
    return {x_m + (index % n + 0.5) * cell_m, y_m + (index / n + 0.5) * cell_m};
  }
};

/// Layers of one stamp: borrowed arrays of the grid's columns, [y][x] from its origin. Each is the LayerId of
/// its name.
struct MapView {
  std::int64_t stamp_ns = 0;
  Grid grid;
  const float* height = nullptr;
  const float* slope = nullptr;
  const float* roughness = nullptr;
  const float* clearance = nullptr;
  const std::uint8_t* flags = nullptr;
  const std::uint8_t* visibility = nullptr;

  [[nodiscard]] Cells cells() const {
    const double cell_m = grid.resolution_m[0];
    return {grid.size[0], cell_m, grid.origin[0] * cell_m, grid.origin[1] * cell_m};
  }
};

/// The same map with other flags, which outlive it.
inline MapView with_flags(MapView map, const std::vector<std::uint8_t>& flags) {
  map.flags = flags.data();
  return map;
}

inline MapView map_view(const LayerArrays& layers, const Grid& grid, std::int64_t stamp_ns) {
  return {stamp_ns,         grid,         layers.height,    layers.slope, layers.roughness,
          layers.clearance, layers.flags, layers.visibility};
}

}  // namespace gvom::planner
