// How the vehicle moves, by its odometry.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/pose.hpp"
#include "services/common/pose_judge.hpp"
#include "services/planner/planner.hpp"

namespace gvom::planner {

enum class MotionNews {
  used,
  jump,       ///< Used, and all before it forgotten: faster than can be from the pose before.
  anew,       ///< Of a newer epoch, or after many that went back in time: likewise.
  old_epoch,  ///< Not used, like the next two.
  backwards,
  not_a_pose,
};

/// Speed and curvature as differences of poses over `kSpan_ns`. What is a jump to those who map is one here.
class MotionEstimate {
 public:
  explicit MotionEstimate(const services::OdometryConfig& config) : judge_(config) {}

  MotionNews take(const StampedPose& pose, std::uint64_t epoch);

  /// By the newest pose; nothing before the first.
  [[nodiscard]] std::optional<State> state() const;
  /// So much later, if it goes on as it did.
  [[nodiscard]] std::optional<State> state_after(std::int64_t passed_ns) const;
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }

 private:
  static constexpr std::int64_t kSpan_ns = 150'000'000;
  static constexpr std::size_t kPoses = 64;  // 0.15 s at 400 Hz; of a faster one a shorter span

  [[nodiscard]] const StampedPose& at(std::size_t back) const;  // 0: the newest

  services::PoseJudge judge_;
  std::array<StampedPose, kPoses> poses_;
  std::size_t taken_ = 0;  // of this motion, all
  std::uint64_t epoch_ = 0;
};

}  // namespace gvom::planner
