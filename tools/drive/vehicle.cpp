#include "tools/drive/vehicle.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::driving {
namespace {

constexpr double kExact_s = 1e-9;      // less is rounding
constexpr double kStands_mps = 0.005;  // slower on the way to 0 is 0
constexpr double kLeastBrake_mps2 = 0.3;

/// From `value` towards `target` as a first-order actuator goes, no faster than the limit.
double approach(double value, double target, double memory_s, double limit_per_s) {
  const double wanted = (target - value) * (1 - std::exp(-kStep_s / memory_s));
  return value + std::clamp(wanted, -limit_per_s * kStep_s, limit_per_s * kStep_s);
}

}  // namespace

Vehicle::Vehicle(const sim::Terrain& terrain, const VehicleModel& model, const planner::Pose2& start)
    : terrain_(terrain), model_(model) {
  state_.place = start;
  stance_ = stand(terrain_, model_, start);
  poses_.push_back(pose_of(model_, start, stance_));
}

void Vehicle::command(double time_s, const planner::Command& command) {
  commands_.push_back({time_s, command});
}

/// What has come through the delay, unless it is too old.
planner::Command Vehicle::heard() {
  const double given_s = time_s() - model_.delay_s + kExact_s;
  while (heard_ < commands_.size() && commands_[heard_].time_s <= given_s) ++heard_;
  if (heard_ == 0) return {0, state_.curvature_per_m};
  const Timed& last = commands_[heard_ - 1];
  if (given_s - last.time_s > model_.command_lasts_s) return {0, last.command.curvature_per_m};
  return last.command;
}

/// Downhill the weight pulls at the wheels' grip.
double Vehicle::brake_mps2() const {
  const double down = std::copysign(1.0, state_.wheel_speed_mps) * stance_.pitch_rad;
  const double held_mps2 = kGravity_mps2 * (model_.grip * std::cos(down) - std::max(0.0, std::sin(down)));
  return std::clamp(held_mps2, kLeastBrake_mps2, model_.limits.max_decel_mps2);
}

void Vehicle::move_actuators(const planner::Command& wanted) {
  const planner::VehicleLimits& limits = model_.limits;
  double& speed = state_.wheel_speed_mps;
  const double target = std::clamp(wanted.speed_mps, -limits.max_speed_mps, limits.max_speed_mps);
  const bool brakes = speed != 0 && (target - speed) * speed < 0;
  speed = approach(speed, target, model_.speed_memory_s, brakes ? brake_mps2() : limits.max_accel_mps2);
  if (target == 0 && std::abs(speed) < kStands_mps) speed = 0;
  const double most = limits.max_curvature_per_m;
  state_.curvature_per_m = approach(state_.curvature_per_m, std::clamp(wanted.curvature_per_m, -most, most),
                                    model_.curvature_memory_s, limits.max_curvature_rate_per_m_s);
}

/// Exact on an arc; what it slides across a slope comes on top.
void Vehicle::move_body() {
  const double up = -std::copysign(1.0, state_.wheel_speed_mps) * stance_.pitch_rad;
  state_.speed_mps = state_.wheel_speed_mps * (1 - model_.climb_slip * std::max(0.0, std::sin(up)));
  const bool skids = model_.limits.steering == planner::Steering::skid_steer;
  const double turned_rad =
      state_.speed_mps * state_.curvature_per_m * (skids ? 1 - model_.turn_slip : 1.0) * kStep_s;
  const double ahead_m = state_.speed_mps * std::cos(stance_.pitch_rad) * kStep_s;
  const double left_m = -model_.side_slip * std::abs(state_.speed_mps) * std::sin(stance_.roll_rad) * kStep_s;
  planner::Pose2& place = state_.place;
  const double chord = turned_rad == 0 ? 1.0 : std::sin(0.5 * turned_rad) / (0.5 * turned_rad);
  const double heading = place.yaw_rad + 0.5 * turned_rad;
  place.x_m += chord * ahead_m * std::cos(heading) - left_m * std::sin(heading);
  place.y_m += chord * ahead_m * std::sin(heading) + left_m * std::cos(heading);
  place.yaw_rad = std::remainder(place.yaw_rad + turned_rad, 2 * M_PI);
}

void Vehicle::step() {
  move_actuators(heard());
  move_body();
  stance_ = stand(terrain_, model_, state_.place);
  poses_.push_back(pose_of(model_, state_.place, stance_));
}

Pose Vehicle::at(double time_s) const {
  const double place = std::clamp(time_s / kStep_s, 0.0, static_cast<double>(poses_.size() - 1));
  const auto from = static_cast<std::size_t>(place);
  const std::size_t to = std::min(from + 1, poses_.size() - 1);
  const double part = place - static_cast<double>(from);
  return {(1 - part) * poses_[from].translation_m + part * poses_[to].translation_m,
          poses_[from].rotation.slerp(part, poses_[to].rotation)};
}

}  // namespace gvom::driving
