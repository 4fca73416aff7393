#include "services/planner/process/motion.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::planner {
namespace {

constexpr double kJump_m = 0.5;      // less is no jump, however quick
constexpr double kCurves_mps = 0.2;  // slower, curvature is noise

bool is_pose(const Pose& pose) {
  return pose.translation_m.allFinite() && pose.rotation.coeffs().allFinite() &&
         std::abs(pose.rotation.norm() - 1.0) < 0.01;
}

}  // namespace

const StampedPose& MotionEstimate::at(std::size_t back) const {
  return poses_[(taken_ - 1 - back) % kPoses];
}

MotionNews MotionEstimate::take(const StampedPose& pose, std::uint64_t epoch) {
  if (!is_pose(pose.T_odom_base)) return MotionNews::not_a_pose;
  if (taken_ != 0 && epoch < epoch_) return MotionNews::old_epoch;
  MotionNews news = MotionNews::used;
  if (taken_ != 0 && epoch == epoch_) {
    const std::int64_t passed_ns = pose.stamp_ns - at(0).stamp_ns;
    if (passed_ns <= 0) return MotionNews::backwards;
    const double way_m = (pose.T_odom_base.translation_m - at(0).T_odom_base.translation_m).norm();
    if (way_m > kJump_m && way_m > max_speed_mps_ * 1e-9 * static_cast<double>(passed_ns))
      news = MotionNews::jump;
  } else if (taken_ != 0) {
    news = MotionNews::anew;
  }
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

}  // namespace gvom::planner
