// The vehicle's recent poses and what lies between them (R3).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/pose.hpp"
#include "core/time_span.hpp"

namespace gvom {

/// What lies between a pose and the one before it. Across a gap or a jump nothing is interpolated.
enum class PoseLink { steady, gap, jump };

/// Whether there is a pose for each moment of a span.
enum class Reach {
  covered,
  later,   ///< Not yet: the newest pose is from before its end.
  before,  ///< It begins before the oldest pose.
  gap,     ///< It reaches into a gap between two poses.
  jump,    ///< ... into a jump.
};

/// A ring of poses in order of time. Allocates at construction only.
class OdometryBuffer {
 public:
  enum class Add { added, not_finite, not_newer };

  /// @param capacity poses kept; the oldest goes when a new one needs its place
  explicit OdometryBuffer(std::size_t capacity = 8192);

  /// Whether `add` would take it, its stamp aside.
  static bool is_usable(const Pose& pose);

  /// Refuses poses that are not finite (or over 10,000 km away) and those not newer than the last.
  /// @param link what lies between it and the pose before
  Add add(const StampedPose& pose, PoseLink link = PoseLink::steady);
  void clear() { size_ = 0; }

  /// `T_odom_base(t)`: translation linearly, rotation by slerp between the two poses around `t`.
  /// Nothing before the first or after the last pose: there is no extrapolation (R3). Nothing in a gap or
  /// jump.
  [[nodiscard]] std::optional<Pose> at(std::int64_t stamp_ns) const;

  /// If covered, `at` has a pose for each moment of the span, and no gap and no jump lies within it.
  [[nodiscard]] Reach reach(const TimeSpan& span) const;

  /// Stamp of the first pose after the last jump that is not after `stamp_ns`; 0: there was none, or it has
  /// left the ring.
  [[nodiscard]] std::int64_t jump_before(std::int64_t stamp_ns) const;

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::int64_t oldest_ns() const { return from_oldest(0).pose.stamp_ns; }
  [[nodiscard]] std::int64_t newest_ns() const { return from_oldest(size_ - 1).pose.stamp_ns; }

 private:
  struct Entry {
    StampedPose pose;
    PoseLink link;         // to the one before it
    std::int64_t jump_ns;  // see jump_before
  };

  [[nodiscard]] const Entry& from_oldest(std::size_t i) const {
    return ring_[(next_ + ring_.size() - size_ + i) % ring_.size()];
  }
  /// Index of the last pose not after the stamp, which is not before the oldest.
  [[nodiscard]] std::size_t last_until(std::int64_t stamp_ns) const;

  std::vector<Entry> ring_;
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

/// The pose a share `alpha` (0 .. 1) of the way from `a` to `b` (R3).
Pose interpolate(const Pose& a, const Pose& b, double alpha);

}  // namespace gvom
