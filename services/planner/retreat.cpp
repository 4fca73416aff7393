#include "services/planner/retreat.hpp"

#include <algorithm>
#include <cmath>

#include "services/planner/arc.hpp"
#include "services/planner/room.hpp"

namespace gvom::planner {
namespace {

constexpr double kWorthIt_m = 1;
constexpr double kLooksBack_m = 1;  // farther than it takes to stop from kSpeed_mps
constexpr double kStep_m = 0.25;

}  // namespace

void Retreat::forget() {
  trail_.clear();
  last_.reset();
  clear();
  backs_ = false;
}

void Retreat::observe(const Pose2& pose) {
  if (backs_ && last_) backed_m_ += (pose.place() - last_->place()).norm();
  trail_.add(pose, backs_);
  last_ = pose;
}

bool Retreat::block(std::int64_t stamp_ns, bool stands, bool blind_behind) {
  if (!stands) blocked_since_ns_.reset();
  if (!stands) return false;
  if (!blocked_since_ns_) blocked_since_ns_ = stamp_ns;
  return stamp_ns - *blocked_since_ns_ >= kPatience_ns && begin(blind_behind);
}

bool Retreat::begin(bool blind_behind) {
  if (blind_behind || std::min(trail_.length_m(), config_.back_out_m) < kWorthIt_m) return false;
  clear();
  backed_m_ = 0;
  return backs_ = true;
}

std::optional<Command> Retreat::back(const Costmap& costs, const Predicted& at) {
  const double left_m = std::min(config_.back_out_m - backed_m_, trail_.length_m() - kWorthIt_m / 2);
  backs_ = left_m > 0;
  if (!backs_) return std::nullopt;
  const double most_per_m = config_.vehicle.max_curvature_per_m;
  const double curvature_per_m = std::clamp(trail_.curvature_back(at.pose), -most_per_m, most_per_m);
  const double start_room_m = room_m(costs, config_.vehicle, at.pose);
  for (double way_m = kStep_m; backs_ && way_m <= kLooksBack_m; way_m += kStep_m) {
    const Pose2 pose = moved(at.pose, -way_m, curvature_per_m);
    backs_ = costs.fits(pose) || gets_no_nearer(costs, config_.vehicle, pose, start_room_m);
  }
  if (!backs_) return std::nullopt;
  const double speed_mps =
      std::min(kSpeed_mps, std::sqrt(2 * left_m) * config_.vehicle.max_decel_mps2 / 4 + 0.1);
  return Command{-speed_mps, curvature_per_m};
}

}  // namespace gvom::planner
