#include "services/common/pose_judge.hpp"

namespace gvom::services {

namespace {

constexpr double kLeastJump_m = 0.5;  // below it is noise
constexpr double kLeastTurn_rad = 0.2;
constexpr double kMostTurn_radps = 6.3;

double seconds_between(const StampedPose& from, const StampedPose& to) {
  return static_cast<double>(to.stamp_ns - from.stamp_ns) * 1e-9;
}

double metres_between(const StampedPose& from, const StampedPose& to) {
  return (to.T_odom_base.translation_m - from.T_odom_base.translation_m).norm();
}

}  // namespace

void PoseJudge::begin_anew() {
  last_.reset();
  backwards_ = 0;
}

bool PoseJudge::jumps(const StampedPose& pose) const {
  const double elapsed_s = seconds_between(*last_, pose);
  const double moved_m = metres_between(*last_, pose);
  const double turned_rad = last_->T_odom_base.rotation.angularDistance(pose.T_odom_base.rotation);
  return (moved_m > kLeastJump_m && moved_m > max_speed_mps_ * elapsed_s) ||
         (turned_rad > kLeastTurn_rad && turned_rad > kMostTurn_radps * elapsed_s);
}

PoseJudge::Verdict PoseJudge::judge(const StampedPose& pose) {
  if (!OdometryBuffer::is_usable(pose.T_odom_base)) return {PoseStep::not_a_pose};
  if (last_ && pose.stamp_ns == last_->stamp_ns) return {PoseStep::repeated};
  if (last_ && pose.stamp_ns < last_->stamp_ns) {
    if (++backwards_ < kAnew) return {PoseStep::backwards};
    begin_anew();
    last_ = pose;
    return {PoseStep::anew};
  }
  backwards_ = 0;
  Verdict verdict{PoseStep::steady};
  if (last_ && seconds_between(*last_, pose) > max_gap_s_)
    verdict = {PoseStep::gap, seconds_between(*last_, pose)};
  if (last_ && jumps(pose)) verdict = {PoseStep::jump, metres_between(*last_, pose)};
  last_ = pose;
  return verdict;
}

}  // namespace gvom::services
