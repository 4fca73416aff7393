// A path that the vehicle can drive, made cheaper in the space of its steering (Overbye and Saripalli, Path
// Optimization for Ground Vehicles in Off-Road Terrain, ICRA 2021).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "services/planner/costmap.hpp"
#include "services/planner/path_cost.hpp"

namespace gvom::planner {

/// A place on a way, `step_m` after the one before.
struct PathPoint {
  Pose2 pose;
  double curvature_per_m = 0;  ///< From here to the next point; of the last point: as before it.
  double z_m = 0;              ///< Of the ground there, in a Plan.
};

/// A list of curvatures over equal steps of length is the path; limits of the vehicle are limits of the list,
/// so whatever the descent does can be driven. What a path costs says PathCost.
class PathOptimiser {
 public:
  static constexpr double kStep_m = 0.5;
  static constexpr int kMostDescents = 15;

  explicit PathOptimiser(const PlannerConfig& config);

  /// Begins with the list that follows `guide` (from the vehicle on), or with the last cycle's where that is
  /// cheaper, and descends by the gradient of its cost: the costmap along it, changes of curvature, and how
  /// far its end is from the guide. `horizon_m` long, or as long as the guide. Never dearer than its begin.
  /// Where the guide is shorter than a step, the path is the start alone.
  const std::vector<PathPoint>& optimise(const Costmap& map, const Pose2& start, double curvature_per_m,
                                         double speed_mps, const std::vector<Eigen::Vector2d>& guide);

  /// Of the last path and of what it began with, as PathCost has it; for tests and for people.
  [[nodiscard]] double cost() const { return cost_; }
  [[nodiscard]] double begin_cost() const { return begin_cost_; }

 private:
  using List = std::vector<double>;

  void set_task(const Costmap& map, const Pose2& start, double curvature_per_m, double speed_mps,
                const std::vector<Eigen::Vector2d>& guide);
  /// Carries `list` on along the guide, from where it ends, to `steps_`.
  void pursue(const std::vector<Eigen::Vector2d>& guide, List& list) const;
  [[nodiscard]] double curvature_to(const Pose2& pose, const Eigen::Vector2d& target) const;
  /// The part of the last path that is still ahead; empty: the vehicle is not on it.
  void shift_last(List& list) const;
  /// Within the vehicle's limits, each value as near to the one before as it has to be.
  void limit(List& list) const;
  void descend();
  /// Goes `pace` down the gradient, less if that is not cheaper. False: no way is.
  bool step_down(double pace);
  void keep_path();

  PlannerConfig config_;
  PathTask task_;
  int steps_ = 0;
  double most_change_per_m_ = 0;  ///< Of the curvature, from step to step.
  double lookahead_m_ = 0;
  double cost_ = 0;
  double begin_cost_ = 0;
  PathCost evaluator_;
  std::vector<Eigen::Vector2d> tail_;
  List list_, other_, slope_, last_slope_;
  std::vector<PathPoint> path_;
};

}  // namespace gvom::planner
