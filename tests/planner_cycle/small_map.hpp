// A map made by hand: flat, known ground, and what a test puts on it.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "services/planner/map_view.hpp"

namespace gvom::test {

class SmallMap {
 public:
  static constexpr double kCell_m = 0.4;

  /// @param n columns along an edge, a multiple of 8
  /// @param x_m, y_m the lower corner in odom, multiples of a cell
  explicit SmallMap(int n, double x_m = 0, double y_m = 0, double cell_m = kCell_m) {
    grid_.size = {n, n, 64};
    grid_.origin = {static_cast<int>(std::lround(x_m / cell_m)), static_cast<int>(std::lround(y_m / cell_m)),
                    0};
    grid_.resolution_m = {cell_m, cell_m, cell_m};
    const auto count = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
    height.assign(count, 0);
    slope.assign(count, 0);
    roughness.assign(count, 0);
    clearance.assign(count, std::numeric_limits<float>::infinity());
    flags.assign(count, 0);
    visibility.assign(count, static_cast<std::uint8_t>(Visibility::ground_seen));
  }

  [[nodiscard]] planner::MapView view(std::int64_t stamp_ns = 0) const {
    return {stamp_ns,         grid_,        height.data(),    slope.data(), roughness.data(),
            clearance.data(), flags.data(), visibility.data()};
  }
  [[nodiscard]] planner::Cells cells() const { return view().cells(); }

  /// Calls `edit(index)` for every cell whose middle `holds(x_m, y_m)`.
  template <class Holds, class Edit>
  void where(Holds holds, Edit edit) {
    for (int i = 0; i < cells().count(); ++i) {
      const Eigen::Vector2d middle = cells().center_of(i);
      if (holds(middle.x(), middle.y())) edit(static_cast<std::size_t>(i));
    }
  }
  template <class Holds>
  void obstacle(Holds holds) {
    where(holds, [&](std::size_t i) { flags[i] = kHard; });
  }
  template <class Holds>
  void hide(Holds holds) {
    where(holds, [&](std::size_t i) {
      height[i] = slope[i] = roughness[i] = std::numeric_limits<float>::quiet_NaN();
      visibility[i] = static_cast<std::uint8_t>(Visibility::unobserved);
    });
  }
  /// @param z_m of x_m and y_m
  template <class Z>
  void shape(Z z_m) {
    for (int i = 0; i < cells().count(); ++i) {
      const Eigen::Vector2d middle = cells().center_of(i);
      height[static_cast<std::size_t>(i)] = static_cast<float>(z_m(middle.x(), middle.y()));
    }
  }

  std::vector<float> height, slope, roughness, clearance;
  std::vector<std::uint8_t> flags, visibility;

 private:
  Grid grid_;
};

/// For SmallMap::where and the like.
inline auto disc(double x_m, double y_m, double radius_m) {
  return [=](double x, double y) { return std::hypot(x - x_m, y - y_m) <= radius_m; };
}
inline auto box(double x0_m, double y0_m, double x1_m, double y1_m) {
  return [=](double x, double y) { return x >= x0_m && x <= x1_m && y >= y0_m && y <= y1_m; };
}

}  // namespace gvom::test
