// Whether the vehicle would stand on ground that is known.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "services/planner/costmap.hpp"

namespace gvom::planner {

/// Looks along the vehicle's outline, `kSide_m` farther out, at points not more than `kBetween_m` apart.
class Sight {
 public:
  static constexpr double kSide_m = 0.1;
  static constexpr double kBetween_m = 0.2;
  static constexpr double kUnder_m = 0.3;

  explicit Sight(const VehicleLimits& vehicle);

  /// Whether all of the outline at `pose` is over known ground, or over what the vehicle stands on at `start`
  /// and `kUnder_m` around that: it carries it already.
  [[nodiscard]] bool is_known(const Costmap& costs, const Pose2& pose, const Pose2& start) const;

 private:
  [[nodiscard]] bool is_under(const Eigen::Vector2d& place_m, const Pose2& start) const;

  VehicleLimits vehicle_;
  std::vector<Eigen::Vector2d> outline_m_;  ///< In base_link: ahead, left.
};

}  // namespace gvom::planner
