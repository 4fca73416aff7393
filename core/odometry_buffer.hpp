// The vehicle's recent poses and what lies between them (R3).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/pose.hpp"

namespace gvom {

/// A ring of poses in order of time. Allocates at construction only.
class OdometryBuffer {
 public:
  enum class Add { added, not_finite, not_newer };

  /// @param capacity poses kept; the oldest goes when a new one needs its place
  explicit OdometryBuffer(std::size_t capacity = 8192);

  /// Whether `add` would take it, its stamp aside.
  static bool is_usable(const Pose& pose);

  /// Refuses poses that are not finite (or over 10,000 km away) and those not newer than the last.
  Add add(const StampedPose& pose);
  void clear() { size_ = 0; }

  /// `T_odom_base(t)`: translation linearly, rotation by slerp between the two poses around `t`.
  /// Nothing before the first or after the last pose: there is no extrapolation (R3).
  [[nodiscard]] std::optional<Pose> at(std::int64_t stamp_ns) const;

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::int64_t oldest_ns() const { return from_oldest(0).stamp_ns; }
  [[nodiscard]] std::int64_t newest_ns() const { return from_oldest(size_ - 1).stamp_ns; }

 private:
  [[nodiscard]] const StampedPose& from_oldest(std::size_t i) const {
    return ring_[(next_ + ring_.size() - size_ + i) % ring_.size()];
  }

  std::vector<StampedPose> ring_;
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

/// The pose a share `alpha` (0 .. 1) of the way from `a` to `b` (R3).
Pose interpolate(const Pose& a, const Pose& b, double alpha);

}  // namespace gvom
