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

OdometryBuffer::Add OdometryBuffer::add(const StampedPose& pose, PoseLink link) {
  if (!is_usable(pose.T_odom_base)) return Add::not_finite;
  if (size_ > 0 && pose.stamp_ns <= newest_ns()) return Add::not_newer;
  const std::int64_t last_jump_ns = size_ > 0 ? from_oldest(size_ - 1).jump_ns : 0;
  ring_[next_] = {pose, link, link == PoseLink::jump ? pose.stamp_ns : last_jump_ns};
  ring_[next_].pose.T_odom_base.rotation.normalize();
  next_ = (next_ + 1) % ring_.size();
  if (size_ < ring_.size()) ++size_;
  return Add::added;
}

std::size_t OdometryBuffer::last_until(std::int64_t stamp_ns) const {
  std::size_t low = 0;
  std::size_t high = size_;
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (from_oldest(middle).pose.stamp_ns <= stamp_ns ? low : high) = middle;
  }
  return low;
}

std::optional<Pose> OdometryBuffer::at(std::int64_t stamp_ns) const {
  if (size_ == 0 || stamp_ns < oldest_ns() || stamp_ns > newest_ns()) return std::nullopt;
  const std::size_t i = last_until(stamp_ns);
  const StampedPose& before = from_oldest(i).pose;
  if (before.stamp_ns == stamp_ns) return before.T_odom_base;
  if (from_oldest(i + 1).link != PoseLink::steady) return std::nullopt;
  const StampedPose& after = from_oldest(i + 1).pose;
  const double alpha =
      static_cast<double>(stamp_ns - before.stamp_ns) / static_cast<double>(after.stamp_ns - before.stamp_ns);
  return interpolate(before.T_odom_base, after.T_odom_base, alpha);
}

Reach OdometryBuffer::reach(const TimeSpan& span) const {
  if (size_ == 0 || newest_ns() < span.last_ns) return Reach::later;
  if (span.first_ns < oldest_ns()) return Reach::before;
  // What links the poses around the span to each other, back from its end.
  std::size_t i = last_until(span.last_ns);
  if (from_oldest(i).pose.stamp_ns < span.last_ns) ++i;
  for (; i > 0 && from_oldest(i).pose.stamp_ns > span.first_ns; --i) {
    const PoseLink link = from_oldest(i).link;
    if (link != PoseLink::steady) return link == PoseLink::gap ? Reach::gap : Reach::jump;
  }
  return Reach::covered;
}

std::int64_t OdometryBuffer::jump_before(std::int64_t stamp_ns) const {
  if (size_ == 0 || stamp_ns < oldest_ns()) return 0;
  return from_oldest(last_until(stamp_ns)).jump_ns;
}

}  // namespace gvom
