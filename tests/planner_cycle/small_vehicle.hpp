// A vehicle that does what is commanded, late: the loop's other half.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>

#include "services/planner/planner.hpp"

namespace gvom::test {

/// Integrated in steps of 10 ms by Euler, so that it shares nothing with the planner's arcs.
class SmallVehicle {
 public:
  SmallVehicle(const planner::VehicleLimits& limits, const planner::Pose2& pose)
      : limits_(limits), pose_(pose), commands_(static_cast<std::size_t>(limits.latency_s / kStep_s)) {}

  static constexpr double kStep_s = 0.01;

  void drive(const planner::Command& command, double seconds) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds / kStep_s)); ++i) {
      commands_.push_back(command);
      step(commands_.front());
      commands_.pop_front();
    }
  }

  [[nodiscard]] const planner::Pose2& pose() const { return pose_; }
  [[nodiscard]] double speed_mps() const { return speed_mps_; }
  [[nodiscard]] double curvature_per_m() const { return curvature_per_m_; }
  [[nodiscard]] planner::State state() const {
    planner::State state;
    state.stamp_ns = std::lround(time_s_ * 1e9);
    state.T_odom_base.translation_m = {pose_.x_m, pose_.y_m, 0};
    state.T_odom_base.rotation = Eigen::AngleAxisd(pose_.yaw_rad, Eigen::Vector3d::UnitZ());
    state.speed_mps = speed_mps_;
    state.curvature_per_m = curvature_per_m_;
    return state;
  }
  /// A corner of its outline, or a place within: shares of its length and width, -1 .. 1 from its middle.
  [[nodiscard]] Eigen::Vector2d outline(double along, double left) const {
    const double ahead_m = (limits_.front_m - limits_.rear_m) / 2 + along * limits_.length_m() / 2;
    const double left_m = left * limits_.width_m / 2;
    const double c = std::cos(pose_.yaw_rad), s = std::sin(pose_.yaw_rad);
    return {pose_.x_m + c * ahead_m - s * left_m, pose_.y_m + s * ahead_m + c * left_m};
  }

 private:
  void step(const planner::Command& command) {
    const bool faster = std::abs(command.speed_mps) > std::abs(speed_mps_);
    const double most = kStep_s * (faster ? limits_.max_accel_mps2 : limits_.max_decel_mps2);
    speed_mps_ += std::clamp(command.speed_mps - speed_mps_, -most, most);
    const double turn = kStep_s * limits_.max_curvature_rate_per_m_s;
    curvature_per_m_ += std::clamp(command.curvature_per_m - curvature_per_m_, -turn, turn);
    pose_.x_m += kStep_s * speed_mps_ * std::cos(pose_.yaw_rad);
    pose_.y_m += kStep_s * speed_mps_ * std::sin(pose_.yaw_rad);
    pose_.yaw_rad += kStep_s * speed_mps_ * curvature_per_m_;
    time_s_ += kStep_s;
  }

  planner::VehicleLimits limits_;
  planner::Pose2 pose_;
  double speed_mps_ = 0, curvature_per_m_ = 0, time_s_ = 0;
  std::deque<planner::Command> commands_;
};

}  // namespace gvom::test
