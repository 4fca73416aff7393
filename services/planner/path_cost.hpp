// What a list of curvatures costs as a path, and how that changes with each of them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "services/planner/costmap.hpp"

namespace gvom::planner {

/// Where a path begins and where its end is wanted. Borrowed.
struct PathTask {
  const Costmap* map = nullptr;
  Pose2 start;
  double curvature_per_m = 0;             ///< Before the first step.
  const Eigen::Vector2d* tail = nullptr;  ///< Points of the guide that the end is wanted near to,
  int tail_points = 0;                    ///< one or more.
};

/// Over N steps of `step_m`, each an arc whose chord is as long as the step:
///
///     sum of cost(p_i) step_m, i = 1 .. N             the costmap along the way
///   + kBendWeight sum of (c_i - c_(i-1))^2            changes of curvature
///   + kEndWeight d^2                                  d from the end to the tail, whose last piece goes on
///
/// The gradient comes from one pass back along the path, the adjoint of the steps forward.
class PathCost {
 public:
  static constexpr double kBendWeight_m2 = 20;
  static constexpr double kEndWeight_per_m2 = 1;

  /// @param most_steps of a list
  PathCost(double step_m, int most_steps);

  /// The cost of a list, infinite never. Keeps the poses for `gradient`.
  double evaluate(const PathTask& task, const std::vector<double>& curvatures);
  /// Of the list that was evaluated last: d cost / d curvature, one for each step.
  void gradient(const PathTask& task, const std::vector<double>& curvatures, std::vector<double>& out) const;
  /// Of the list that was evaluated last, one more than it has steps.
  [[nodiscard]] const std::vector<Pose2>& poses() const { return poses_; }

 private:
  double step_m_;
  std::vector<Pose2> poses_;
  std::vector<Eigen::Vector2d> slopes_;  ///< Of the costmap at each pose.
};

/// The pose after one step.
Pose2 step_along(const Pose2& pose, double curvature_per_m, double step_m);

/// From the tail's nearest point to `place`, metres.
Eigen::Vector2d off_tail(const PathTask& task, const Eigen::Vector2d& place);

}  // namespace gvom::planner
