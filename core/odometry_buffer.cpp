#include "core/odometry_buffer.hpp"

#include <cmath>

namespace gvom {

namespace {

constexpr double kFarthest_m = 1e7;  // world voxels stay within int32 down to edges of 1 cm

}  // namespace

bool OdometryBuffer::is_usable(const Pose& pose) {
  return pose.translation_m.allFinite() && pose.translation_m.cwiseAbs().maxCoeff() <= kFarthest_m &&
         pose.rotation.coeffs().allFinite() && std::abs(pose.rotation.squaredNorm() - 1.0) < 1e-3;
}

Pose interpolate(const Pose& a, const Pose& b, double alpha) {
  return {a.translation_m + alpha * (b.translation_m - a.translation_m), a.rotation.slerp(alpha, b.rotation)};
}

OdometryBuffer::OdometryBuffer(std::size_t capacity) : ring_(capacity) {}

OdometryBuffer::Add OdometryBuffer::add(const StampedPose& pose) {
  if (!is_usable(pose.T_odom_base)) return Add::not_finite;
  if (size_ > 0 && pose.stamp_ns <= newest_ns()) return Add::not_newer;
  ring_[next_] = pose;
  ring_[next_].T_odom_base.rotation.normalize();
  next_ = (next_ + 1) % ring_.size();
  if (size_ < ring_.size()) ++size_;
  return Add::added;
}

std::optional<Pose> OdometryBuffer::at(std::int64_t stamp_ns) const {
  if (size_ == 0 || stamp_ns < oldest_ns() || stamp_ns > newest_ns()) return std::nullopt;
  std::size_t low = 0;  // the last pose not after the stamp
  std::size_t high = size_;
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (from_oldest(middle).stamp_ns <= stamp_ns ? low : high) = middle;
  }
  const StampedPose& before = from_oldest(low);
  if (before.stamp_ns == stamp_ns) return before.T_odom_base;
  const StampedPose& after = from_oldest(low + 1);
  const double alpha =
      static_cast<double>(stamp_ns - before.stamp_ns) / static_cast<double>(after.stamp_ns - before.stamp_ns);
  return interpolate(before.T_odom_base, after.T_odom_base, alpha);
}

}  // namespace gvom
