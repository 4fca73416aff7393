// A driver that does not look at the map: pure pursuit along a polyline at constant speed.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "tools/drive/loop.hpp"

namespace gvom::test {

class Pursuit {
 public:
  static constexpr double kAhead_m = 2.5;
  static constexpr double kStep_m = 0.2;

  /// @param path_m corners in odom
  Pursuit(const std::vector<Eigen::Vector2d>& path_m, double speed_mps) : speed_mps_(speed_mps) {
    for (std::size_t i = 0; i + 1 < path_m.size(); ++i) {
      const Eigen::Vector2d piece = path_m[i + 1] - path_m[i];
      const int steps = std::max(1, static_cast<int>(piece.norm() / kStep_m));
      for (int step = 0; step < steps; ++step) points_m_.emplace_back(path_m[i] + piece * step / steps);
    }
    points_m_.push_back(path_m.back());
  }

  driving::Decision operator()(const driving::Seen& seen) {
    const Eigen::Vector2d base = seen.state.T_odom_base.translation_m.head<2>();
    const Eigen::Vector3d forward = seen.state.T_odom_base.rotation * Eigen::Vector3d::UnitX();
    const auto distance_m = [&](std::size_t point) { return (points_m_[point] - base).norm(); };
    while (nearest_ + 1 < points_m_.size() && distance_m(nearest_ + 1) <= distance_m(nearest_)) ++nearest_;
    std::size_t target = nearest_;
    while (target + 1 < points_m_.size() && distance_m(target) < kAhead_m) ++target;
    if (nearest_ + 1 == points_m_.size()) return {planner::Command{}, true};
    const Eigen::Vector2d way = points_m_[target] - base;
    const double left_m = forward.x() * way.y() - forward.y() * way.x();
    return {planner::Command{speed_mps_, 2 * left_m / way.squaredNorm()}, false};
  }

 private:
  std::vector<Eigen::Vector2d> points_m_;
  double speed_mps_;
  std::size_t nearest_ = 0;
};

}  // namespace gvom::test
