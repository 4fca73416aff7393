// How near a vehicle is to what would really end its drive.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "services/common/planner_config.hpp"
#include "services/planner/map_view.hpp"
#include "tools/sim/ground_truth.hpp"
#include "tools/sim/world.hpp"

namespace gvom::driving {

/// From corner to corner, metres in odom.
using Edge = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

class TrueObstacles {
 public:
  static constexpr double kReach_m = 10.0;

  /// Columns that are lethal by the truth, and all rocks. World and truth must outlive it.
  TrueObstacles(const sim::World& world, const sim::GroundTruth& truth);

  /// From the vehicle's outline to the nearest column or walker, metres, at most `kReach_m`; 0: it touches.
  [[nodiscard]] double nearest_m(const planner::VehicleLimits& vehicle, const planner::Pose2& place,
                                 double time_s) const;

  /// Of the columns that are obstacles, where they border on others that are none.
  [[nodiscard]] std::vector<Edge> edges() const;
  /// Around each walker at that time.
  [[nodiscard]] std::vector<Edge> walker_edges(double time_s) const;

 private:
  [[nodiscard]] bool is_obstacle(int x, int y) const;

  const sim::World& world_;
  double cell_m_, min_x_m_, min_y_m_;
  int size_x_, size_y_;
  std::vector<std::uint8_t> is_obstacle_;  // [y][x]
};

}  // namespace gvom::driving
