#include "services/planner/process/motion.hpp"

#include <algorithm>
#include <cmath>

#include "services/planner/arc.hpp"

namespace gvom::planner {
namespace {

constexpr double kCurves_mps = 0.2;  // slower, curvature is noise

}  // namespace

const StampedPose& MotionEstimate::at(std::size_t back) const {
  return poses_[(taken_ - 1 - back) % kPoses];
}

MotionNews MotionEstimate::take(const StampedPose& pose, std::uint64_t epoch) {
  using services::PoseStep;
  if (!OdometryBuffer::is_usable(pose.T_odom_base)) return MotionNews::not_a_pose;
  if (taken_ != 0 && epoch < epoch_) return MotionNews::old_epoch;
  const bool newer = taken_ != 0 && epoch != epoch_;
  if (newer) judge_.begin_anew();
  const PoseStep step = judge_.judge(pose).step;
  if (step == PoseStep::backwards || step == PoseStep::repeated) return MotionNews::backwards;
  MotionNews news = MotionNews::used;
  if (step == PoseStep::jump) news = MotionNews::jump;
  if (newer || step == PoseStep::anew) news = MotionNews::anew;
  if (news != MotionNews::used) taken_ = 0;
  epoch_ = epoch;
  poses_[taken_++ % kPoses] = pose;
  return news;
}

std::optional<State> MotionEstimate::state() const {
  if (taken_ == 0) return std::nullopt;
  const StampedPose& now = at(0);
  State state;
  state.stamp_ns = now.stamp_ns;
  state.T_odom_base = now.T_odom_base;
  const std::size_t kept = std::min(taken_, kPoses);
  std::size_t back = 0;
  while (back + 1 < kept && now.stamp_ns - at(back).stamp_ns < kSpan_ns) ++back;
  if (back == 0) return state;
  const StampedPose& then = at(back);
  const double passed_s = 1e-9 * static_cast<double>(now.stamp_ns - then.stamp_ns);
  const double yaw = flat(now.T_odom_base).yaw_rad, turned = yaw - flat(then.T_odom_base).yaw_rad;
  const double turned_rad = std::remainder(turned, 2 * M_PI);
  const Eigen::Vector2d way = (now.T_odom_base.translation_m - then.T_odom_base.translation_m).head<2>();
  const double middle = yaw - 0.5 * turned_rad;
  state.speed_mps = way.dot(Eigen::Vector2d(std::cos(middle), std::sin(middle))) / passed_s;
  if (std::abs(state.speed_mps) > kCurves_mps)
    state.curvature_per_m = turned_rad / passed_s / state.speed_mps;
  return state;
}

std::optional<State> MotionEstimate::state_after(std::int64_t passed_ns) const {
  std::optional<State> state = this->state();
  if (!state) return state;
  const double way_m = state->speed_mps * 1e-9 * static_cast<double>(passed_ns);
  const Pose2 before = flat(state->T_odom_base), after = moved(before, way_m, state->curvature_per_m);
  Pose& pose = state->T_odom_base;
  pose.translation_m.head<2>() = after.place();
  pose.rotation = Eigen::AngleAxisd(after.yaw_rad - before.yaw_rad, Eigen::Vector3d::UnitZ()) * pose.rotation;
  state->stamp_ns += passed_ns;
  return state;
}

}  // namespace gvom::planner
