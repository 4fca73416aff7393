#include "services/planner/course.hpp"

#include <algorithm>
#include <utility>

namespace gvom::planner {
namespace {

constexpr double kJump = 5;  // more between two cycles is news of the map

}  // namespace

void Course::set(std::vector<Eigen::Vector2d> waypoints_m, std::size_t first) {
  waypoints_m_ = std::move(waypoints_m);
  index_ = first < waypoints_m_.size() ? first : 0;
  begun_ = false;
}

void Course::begin(const Eigen::Vector2d& from_m) {
  goal_m_ = waypoint();
  approach_ = waypoint() - from_m;
  begun_ = true;
}

void Course::update(const Eigen::Vector2d& vehicle_m) {
  if (empty()) return;
  if (!begun_) begin(vehicle_m);
  while (!is_last()) {
    const Eigen::Vector2d beyond = vehicle_m - waypoint();
    const bool passed = beyond.dot(approach_) > 0 && beyond.norm() <= kPassed * config_.goal_tolerance_m;
    if (!at_goal(vehicle_m) && !passed) return;
    const Eigen::Vector2d from_m = waypoint();
    ++index_;
    begin(from_m);
  }
}

bool Progress::update(std::int64_t stamp_ns, double cost_to_go, double distance_m) {
  if (!begun_) {
    begun_ = true;
    since_progress_s_ = since_best_s_ = 0;
    cost_ = least_cost_ = cost_to_go;
    distance_m_ = least_m_ = distance_m;
    last_ns_ = stamp_ns;
    return false;
  }
  const double seconds = std::clamp(static_cast<double>(stamp_ns - last_ns_) * 1e-9, 0.0, kMostAtOnce_s);
  last_ns_ = stamp_ns;
  since_progress_s_ += seconds;
  since_best_s_ += seconds;
  if (cost_to_go > cost_ + kJump) cost_ = cost_to_go;
  if (cost_to_go <= cost_ - kLess || distance_m <= distance_m_ - kLess) {
    cost_ = std::min(cost_, cost_to_go);
    distance_m_ = std::min(distance_m_, distance_m);
    since_progress_s_ = 0;
  }
  if (cost_to_go <= least_cost_ - kLess || distance_m <= least_m_ - kLess) {
    least_cost_ = std::min(least_cost_, cost_to_go);
    least_m_ = std::min(least_m_, distance_m);
    since_best_s_ = 0;
  }
  return since_progress_s_ > give_up_s_ || since_best_s_ > kPatience * give_up_s_;
}

void Progress::wait(std::int64_t stamp_ns) {
  last_ns_ = stamp_ns;
}

}  // namespace gvom::planner
