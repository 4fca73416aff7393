#include "services/planner/trail.hpp"

#include "services/planner/arc.hpp"

namespace gvom::planner {

void Trail::add(const Pose2& pose, bool backs) {
  if (backs) {
    const auto is_ahead = [&](const Pose2& driven) {
      return (driven.place() - pose.place()).dot(pose.forward()) > -kStep_m;
    };
    while (!poses_.empty() && is_ahead(poses_.back())) poses_.pop_back();
    return;
  }
  if (!poses_.empty() && (poses_.back().place() - pose.place()).norm() < kStep_m) return;
  if (poses_.size() == kMost) poses_.erase(poses_.begin());
  poses_.push_back(pose);
}

double Trail::length_m() const {
  double sum_m = 0;
  for (std::size_t i = 1; i < poses_.size(); ++i) sum_m += (poses_[i].place() - poses_[i - 1].place()).norm();
  return sum_m;
}

double Trail::curvature_back(const Pose2& pose) const {
  for (auto driven = poses_.rbegin(); driven != poses_.rend(); ++driven)
    if ((driven->place() - pose.place()).norm() >= kLookAhead_m) return curvature_to(pose, driven->place());
  return curvature_to(pose, poses_.front().place());
}

}  // namespace gvom::planner
