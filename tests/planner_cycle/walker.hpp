// Somebody on a map made by hand.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/planner_cycle/small_map.hpp"
#include "tests/planner_cycle/small_vehicle.hpp"

namespace gvom::test {

/// For SmallMap::where: the cells that a person so wide touches.
inline auto touched_by(const Eigen::Vector2d& middle_m, double radius_m, double cell_m) {
  return [=](double x, double y) {
    return std::hypot(std::max(0.0, std::abs(x - middle_m.x()) - cell_m / 2),
                      std::max(0.0, std::abs(y - middle_m.y()) - cell_m / 2)) < radius_m;
  };
}

/// Puts whoever walks into a map, turn by turn: all cells that he touches.
class Walker {
 public:
  static constexpr double kRadius_m = 0.3;

  /// @param flag that the map shows him as
  Walker(SmallMap& map, std::uint8_t flag) : map_(map), flag_(flag), empty_(map.flags) {}

  void stand_at(const Eigen::Vector2d& middle_m) {
    middle_m_ = middle_m;
    map_.flags = empty_;
    map_.where(touched_by(middle_m, kRadius_m, map_.cells().cell_m),
               [&](std::size_t i) { map_.flags[i] = flag_; });
  }
  [[nodiscard]] double away_m(const SmallVehicle& vehicle) const {
    double least_m = 1e9;
    for (int i = -10; i <= 10; ++i)
      for (int k = -10; k <= 10; ++k)
        least_m = std::min(least_m, (vehicle.outline(i / 10.0, k / 10.0) - middle_m_).norm());
    return least_m - kRadius_m;
  }

 private:
  SmallMap& map_;
  std::uint8_t flag_;
  std::vector<std::uint8_t> empty_;
  Eigen::Vector2d middle_m_{0, 0};
};

}  // namespace gvom::test
