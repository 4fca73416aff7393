#include "services/planner/path_cost.hpp"

#include <algorithm>

namespace gvom::planner {

PathCost::PathCost(double step_m, int most_steps) : step_m_(step_m) {
  poses_.reserve(most_steps + 1);
  slopes_.reserve(most_steps + 1);
}

double PathCost::evaluate(const PathTask& task, const std::vector<double>& curvatures) {
  poses_.assign(1, task.start);
  slopes_.assign(1, Eigen::Vector2d::Zero());
  double cost = 0, before = task.curvature_per_m;
  for (const double curvature : curvatures) {
    poses_.push_back(step_along(poses_.back(), curvature, step_m_));
    const CostSample here = task.map->sample(poses_.back().x_m, poses_.back().y_m);
    slopes_.push_back(here.gradient);
    cost += here.cost * step_m_ + kBendWeight_m2 * (curvature - before) * (curvature - before);
    before = curvature;
  }
  return cost + kEndWeight_per_m2 * off_tail(task, poses_.back().place()).squaredNorm();
}

// `pull` and `turn` are what the cost of all that comes after a pose gains by moving and by turning it.
void PathCost::gradient(const PathTask& task, const std::vector<double>& curvatures,
                        std::vector<double>& out) const {
  const int steps = static_cast<int>(curvatures.size());
  out.resize(steps);
  Eigen::Vector2d pull = 2 * kEndWeight_per_m2 * off_tail(task, poses_.back().place());
  double turn = 0;
  for (int i = steps - 1; i >= 0; --i) {
    pull += slopes_[i + 1] * step_m_;
    const double chord_rad = poses_[i].yaw_rad + curvatures[i] * step_m_ / 2;
    const double swing = step_m_ * (pull.y() * std::cos(chord_rad) - pull.x() * std::sin(chord_rad));
    const double before = i > 0 ? curvatures[i - 1] : task.curvature_per_m;
    const double bend = curvatures[i] - before;
    const double next_bend = i + 1 < steps ? curvatures[i + 1] - curvatures[i] : 0;
    out[i] = (turn + swing / 2) * step_m_ + 2 * kBendWeight_m2 * (bend - next_bend);
    turn += swing;
  }
}

Pose2 step_along(const Pose2& pose, double curvature_per_m, double step_m) {
  const double turn_rad = curvature_per_m * step_m, chord_rad = pose.yaw_rad + turn_rad / 2;
  return {pose.x_m + step_m * std::cos(chord_rad), pose.y_m + step_m * std::sin(chord_rad),
          pose.yaw_rad + turn_rad};
}

Eigen::Vector2d off_tail(const PathTask& task, const Eigen::Vector2d& place) {
  Eigen::Vector2d least = place - task.tail[0];
  for (int i = 0; i + 1 < task.tail_points; ++i) {
    const Eigen::Vector2d along = task.tail[i + 1] - task.tail[i], off = place - task.tail[i];
    if (along.squaredNorm() == 0) continue;
    const bool goes_on = i + 2 == task.tail_points;
    const double share = std::max(off.dot(along) / along.squaredNorm(), 0.0);
    const Eigen::Vector2d here = off - along * (goes_on ? share : std::min(share, 1.0));
    if (here.squaredNorm() < least.squaredNorm()) least = here;
  }
  return least;
}

}  // namespace gvom::planner
