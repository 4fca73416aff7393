#include "tools/drive/pictures/film.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::driving {
namespace {

template <class Value>
std::vector<Value> copy_of(const Value* values, std::size_t count) {
  return {values, values + count};
}

/// `count` of them, evenly spaced, the last always.
void pick_from(const std::vector<const Frame*>& all, std::size_t count, std::vector<const Frame*>& out) {
  const std::size_t picked = std::min(count, all.size());
  for (std::size_t i = 0; i < picked; ++i)
    out.push_back(all[picked == 1 ? all.size() - 1 : i * (all.size() - 1) / (picked - 1)]);
}

}  // namespace

Frame Film::frame_of(const Seen& seen, const planner::Plan& plan) const {
  const std::size_t n = static_cast<std::size_t>(seen.grid.size[0]) * seen.grid.size[1];
  Frame frame;
  frame.stamp_ns = seen.state.stamp_ns;
  frame.time_s = 1e-9 * static_cast<double>(seen.state.stamp_ns - first_ns_);
  frame.place = planner::flat(seen.state.T_odom_base);
  frame.speed_mps = seen.state.speed_mps;
  frame.grid = seen.grid;
  frame.height = copy_of(seen.layers.height, n);
  frame.slope_x = copy_of(seen.layers.slope_x, n);
  frame.slope_y = copy_of(seen.layers.slope_y, n);
  frame.flags = copy_of(seen.layers.flags, n);
  frame.visibility = copy_of(seen.layers.visibility, n);
  for (const planner::PathPoint& point : plan.path) frame.path.push_back(point.pose.place());
  for (const planner::TrajectoryPoint& point : plan.trajectory)
    frame.trajectory.push_back(point.pose.place());
  frame.why = plan.why;
  frame.driven = way_.size();
  return frame;
}

void Film::add(const Seen& seen, const planner::Plan& plan) {
  if (way_.empty()) first_ns_ = seen.state.stamp_ns;
  way_.push_back(seen.state.T_odom_base.translation_m.head<2>());
  const double time_s = 1e-9 * static_cast<double>(seen.state.stamp_ns - first_ns_);
  if (frames_.empty() || time_s >= frames_.back().time_s + every_s_) frames_.push_back(frame_of(seen, plan));
  if (frames_.size() > kMostFrames) {  // each second one goes, and the next ones are twice as far apart
    for (std::size_t i = 1; 2 * i < frames_.size(); ++i) frames_[i] = std::move(frames_[2 * i]);
    frames_.resize((frames_.size() + 1) / 2);
    every_s_ *= 2;
  }
  // The newest is always there; the one before it stays if it is far enough from its own.
  if (last_.size() >= 2 && last_.back().time_s < last_[last_.size() - 2].time_s + kBetweenLast_s)
    last_.pop_back();
  last_.push_back(frame_of(seen, plan));
  if (last_.size() > kLastFrames) last_.erase(last_.begin());
}

std::vector<const Frame*> Film::pick(std::size_t count) const {
  std::vector<const Frame*> all, picked;
  for (const Frame& frame : frames_)
    if (frame.time_s < last_.back().time_s) all.push_back(&frame);
  if (!last_.empty()) all.push_back(&last_.back());
  pick_from(all, count, picked);
  return picked;
}

std::vector<const Frame*> Film::pick_end(std::size_t count) const {
  std::vector<const Frame*> all, end, picked;
  if (last_.empty()) return picked;
  for (const Frame& frame : frames_)
    if (frame.time_s < last_.front().time_s) all.push_back(&frame);
  for (const Frame& frame : last_) end.push_back(&frame);
  const std::size_t of_end = std::min(end.size(), (count + 1) / 2);
  pick_from(all, count - of_end, picked);
  pick_from(end, of_end, picked);
  return picked;
}

}  // namespace gvom::driving
