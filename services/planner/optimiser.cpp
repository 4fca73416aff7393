#include "services/planner/optimiser.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::planner {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLeastLookahead_m = 2.0;
constexpr double kLookahead_s = 0.8;
constexpr double kFirstChange_per_m = 0.05;  // of the first descent, at most
constexpr int kMostHalvings = 8;
constexpr int kTailPoints = 1000;  // of the guide within a horizon, more than any has
constexpr double kOffLast_m = 1.0, kOffLast_rad = 0.5;

int most_steps(double horizon_m) {
  return static_cast<int>(horizon_m / PathOptimiser::kStep_m + 1e-9);
}

double length_of(const std::vector<Eigen::Vector2d>& line) {
  double length_m = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length_m += (line[i] - line[i - 1]).norm();
  return length_m;
}

// The points of `line` between two lengths along it, and the one beyond.
void cut_out(const std::vector<Eigen::Vector2d>& line, double from_m, double to_m,
             std::vector<Eigen::Vector2d>& out) {
  out.clear();
  double along_m = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double next_m = i + 1 < line.size() ? along_m + (line[i + 1] - line[i]).norm() : along_m;
    if (next_m >= from_m) out.push_back(line[i]);
    if (along_m > to_m) return;
    along_m = next_m;
  }
}

}  // namespace

PathOptimiser::PathOptimiser(const PlannerConfig& config)
    : config_(config), evaluator_(kStep_m, most_steps(config.horizon_m)) {
  const int steps = most_steps(config.horizon_m);
  for (List* list : {&list_, &other_, &slope_, &last_slope_}) list->reserve(steps);
  path_.reserve(steps + 1);
  tail_.reserve(kTailPoints);
}

const std::vector<PathPoint>& PathOptimiser::optimise(const Costmap& map, const Pose2& start,
                                                      double curvature_per_m, double speed_mps,
                                                      const std::vector<Eigen::Vector2d>& guide) {
  set_task(map, start, curvature_per_m, speed_mps, guide);
  if (steps_ == 0) {
    cost_ = begin_cost_ = 0;
    path_.assign(1, {start, curvature_per_m});
    return path_;
  }
  shift_last(other_);
  const bool on_last = !other_.empty();
  list_.clear();
  pursue(guide, list_);
  limit(list_);
  cost_ = evaluator_.evaluate(task_, list_);
  if (on_last) {
    pursue(guide, other_);
    limit(other_);
    const double last_cost = evaluator_.evaluate(task_, other_);
    if (last_cost < cost_) {
      cost_ = last_cost;
      list_.swap(other_);
    }
  }
  begin_cost_ = cost_;
  descend();
  keep_path();
  return path_;
}

void PathOptimiser::set_task(const Costmap& map, const Pose2& start, double curvature_per_m, double speed_mps,
                             const std::vector<Eigen::Vector2d>& guide) {
  const double speed = std::fabs(speed_mps), most = config_.vehicle.max_curvature_per_m;
  const double length_m = std::min(config_.horizon_m, length_of(guide));
  steps_ = most_steps(length_m);
  lookahead_m_ = std::max(kLeastLookahead_m, kLookahead_s * speed);
  most_change_per_m_ = config_.vehicle.max_curvature_rate_per_m_s * kStep_m / std::max(speed, 1.0);
  cut_out(guide, length_m / 2, 1.25 * length_m, tail_);
  task_ = {&map, start, std::clamp(curvature_per_m, -most, most), tail_.data(),
           static_cast<int>(tail_.size())};
}

// Pure pursuit (Coulter, 1992): on the arc to the first place of the guide that is not yet near.
void PathOptimiser::pursue(const std::vector<Eigen::Vector2d>& guide, List& list) const {
  Pose2 pose = task_.start;
  double before = task_.curvature_per_m;
  std::size_t next = 0;
  const Eigen::Vector2d last = guide.back() - guide[guide.size() - 2];
  const Eigen::Vector2d beyond =
      last.norm() > 0 ? guide.back() + last.normalized() * lookahead_m_ : guide.back();
  list.reserve(steps_);
  for (int i = 0; i < steps_; ++i) {
    while (next < guide.size() && (guide[next] - pose.place()).norm() < lookahead_m_) ++next;
    if (i == static_cast<int>(list.size())) {
      const double wanted = curvature_to(pose, next < guide.size() ? guide[next] : beyond);
      list.push_back(std::clamp(wanted, before - most_change_per_m_, before + most_change_per_m_));
    }
    before = list[i];
    pose = step_along(pose, before, kStep_m);
  }
}

double PathOptimiser::curvature_to(const Pose2& pose, const Eigen::Vector2d& target) const {
  const double most = config_.vehicle.max_curvature_per_m;
  const Eigen::Vector2d off = target - pose.place(), forward = pose.forward();
  const double ahead = off.dot(forward), aside = forward.x() * off.y() - forward.y() * off.x();
  if (ahead < 0) return aside < 0 ? -most : most;
  return std::clamp(2 * aside / std::max(off.squaredNorm(), kStep_m * kStep_m), -most, most);
}

void PathOptimiser::shift_last(List& list) const {
  list.clear();
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < path_.size(); ++i) {
    const auto off_m = [&](std::size_t k) { return (path_[k].pose.place() - task_.start.place()).norm(); };
    if (off_m(i) < off_m(nearest)) nearest = i;
  }
  if (nearest + 1 >= path_.size()) return;
  const Pose2& pose = path_[nearest].pose;
  const Eigen::Vector2d off = task_.start.place() - pose.place();
  const double turned_rad = std::remainder(task_.start.yaw_rad - pose.yaw_rad, 2 * kPi);
  if (off.norm() > kOffLast_m || std::fabs(turned_rad) > kOffLast_rad) return;
  const double share = off.dot(pose.forward()) / kStep_m;
  const std::size_t from = share < 0 && nearest > 0 ? nearest - 1 : nearest;
  const double passed = std::clamp(share + static_cast<double>(nearest - from), 0.0, 1.0);
  for (std::size_t i = from; i + 1 < path_.size() && static_cast<int>(list.size()) < steps_; ++i)
    list.push_back((1 - passed) * path_[i].curvature_per_m + passed * path_[i + 1].curvature_per_m);
}

void PathOptimiser::limit(List& list) const {
  const double most = config_.vehicle.max_curvature_per_m;
  double before = task_.curvature_per_m;
  for (double& curvature : list) {
    curvature = std::clamp(curvature, std::max(before - most_change_per_m_, -most),
                           std::min(before + most_change_per_m_, most));
    before = curvature;
  }
}

// The pace is Barzilai and Borwein's (Two-Point Step Size Gradient Methods, 1988): how far the last step went
// by how much the gradient changed on it.
void PathOptimiser::descend() {
  evaluator_.evaluate(task_, list_);
  evaluator_.gradient(task_, list_, slope_);
  double steepest = 0;
  for (const double slope : slope_) steepest = std::max(steepest, std::fabs(slope));
  if (steepest == 0) return;
  double pace = kFirstChange_per_m / steepest;
  for (int i = 0; i < kMostDescents; ++i) {
    if (!step_down(pace)) return;
    last_slope_.swap(slope_);
    evaluator_.gradient(task_, list_, slope_);
    double moved = 0, changed = 0;
    for (int k = 0; k < steps_; ++k) {
      const double step = list_[k] - other_[k];
      moved += step * step;
      changed += step * (slope_[k] - last_slope_[k]);
    }
    pace = changed > 0 ? moved / changed : 2 * pace;
  }
}

bool PathOptimiser::step_down(double pace) {
  other_ = list_;
  for (int halvings = 0; halvings <= kMostHalvings; ++halvings, pace /= 2) {
    for (int i = 0; i < steps_; ++i) list_[i] = other_[i] - pace * slope_[i];
    limit(list_);
    const double cost = evaluator_.evaluate(task_, list_);
    if (cost < cost_) {
      cost_ = cost;
      return true;
    }
  }
  list_ = other_;
  evaluator_.evaluate(task_, list_);
  return false;
}

void PathOptimiser::keep_path() {
  path_.clear();
  for (int i = 0; i <= steps_; ++i) path_.push_back({evaluator_.poses()[i], list_[std::min(i, steps_ - 1)]});
}

}  // namespace gvom::planner
