#include "services/planner/speed.hpp"

#include <algorithm>
#include <cmath>

#include "services/planner/fan.hpp"
#include "services/planner/stance.hpp"

namespace gvom::planner {
namespace {

constexpr double kGravity_mps2 = 9.81;
constexpr double kPi = 3.14159265358979323846;
constexpr double kStep_m = Fan::kStep_m;

}  // namespace

SpeedProfile::SpeedProfile(const PlannerConfig& config, std::size_t most_points) : config_(config) {
  limits_.reasons.reserve(most_points);
  limits_.reason_places_m.reserve(most_points);
}

const SpeedLimits& SpeedProfile::make(const MapView& map, double speed_mps, double seen_m, End end,
                                      std::vector<TrajectoryPoint>& trajectory) {
  limits_.reasons.assign(trajectory.size(), Reason::none);
  limits_.reason_places_m.clear();
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    trajectory[i].speed_mps = std::min(config_.speed_mps, config_.vehicle.max_speed_mps);
    limits_.reason_places_m.push_back(static_cast<double>(i) * kStep_m);
  }
  limit_by_ground(map, trajectory);
  limit_by_curves(trajectory);
  limit_by_sight(seen_m, trajectory);
  limit_by_end(end, trajectory);
  brake_and_accelerate(speed_mps, trajectory);
  return limits_;
}

void SpeedProfile::limit(std::size_t i, double speed_mps, Reason reason,
                         std::vector<TrajectoryPoint>& trajectory) {
  if (speed_mps >= trajectory[i].speed_mps) return;
  trajectory[i].speed_mps = speed_mps;
  limits_.reasons[i] = reason;
}

void SpeedProfile::limit_by_ground(const MapView& map, std::vector<TrajectoryPoint>& trajectory) {
  const VehicleLimits& vehicle = config_.vehicle;
  const double full_mps = std::min(config_.speed_mps, vehicle.max_speed_mps);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const TrajectoryPoint& at = trajectory[i];
    const double bump_m = std::sqrt(roughness_at(map, vehicle, at.pose));
    if (bump_m > 0)
      limit(i, kBump_m / (2 * kPi) * std::sqrt(kVertical_mps2 / bump_m), Reason::rough, trajectory);
    const double tilt = std::max(std::abs(at.roll_rad) / vehicle.max_roll_rad,
                                 std::abs(at.pitch_rad) / vehicle.max_pitch_rad);
    const double beyond = std::clamp(2 * tilt - 1, 0.0, 1.0);
    limit(i, full_mps + beyond * (config_.creep_mps - full_mps), Reason::steep, trajectory);
  }
}

void SpeedProfile::limit_by_curves(std::vector<TrajectoryPoint>& trajectory) {
  const VehicleLimits& vehicle = config_.vehicle;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const double curvature_per_m = std::abs(trajectory[i].curvature_per_m);
    if (curvature_per_m > 1e-6)
      limit(i, std::sqrt(vehicle.max_lateral_accel_mps2 / curvature_per_m), Reason::curve, trajectory);
    if (i == 0) continue;
    const double change_per_m = std::abs(trajectory[i].curvature_per_m - trajectory[i - 1].curvature_per_m);
    if (change_per_m > 1e-6)
      limit(i, vehicle.max_curvature_rate_per_m_s * kStep_m / change_per_m, Reason::curve, trajectory);
  }
}

void SpeedProfile::limit_by_sight(double seen_m, std::vector<TrajectoryPoint>& trajectory) {
  limits_.creeps_to_m = seen_m - kCreepTo_m;
  if (seen_m >= static_cast<double>(trajectory.size() - 1) * kStep_m) return;
  const double latency_s = config_.vehicle.latency_s;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const double at_m = static_cast<double>(i) * kStep_m;
    const double brake = brake_mps2(trajectory[i]);
    const double left_m = std::max(0.0, seen_m - kUnseenMargin_m - at_m);
    double can_mps = brake * (std::sqrt(latency_s * latency_s + 2 * left_m / brake) - latency_s);
    can_mps = at_m < limits_.creeps_to_m ? std::max(can_mps, config_.creep_mps) : 0;
    limit(i, can_mps, Reason::unseen_ground, trajectory);
    if (limits_.reasons[i] == Reason::unseen_ground) limits_.reason_places_m[i] = seen_m;
  }
}

void SpeedProfile::limit_by_end(End end, std::vector<TrajectoryPoint>& trajectory) {
  const std::size_t last = trajectory.size() - 1;
  const Reason reason = end == End::goal      ? Reason::near_goal
                        : end == End::blocked ? Reason::no_trajectory
                                              : Reason::none;
  limit(last, 0, reason, trajectory);
}

double SpeedProfile::brake_mps2(const TrajectoryPoint& at) const {
  const double most = config_.vehicle.max_decel_mps2;
  const double downhill = std::max(0.0, std::sin(at.pitch_rad));
  return std::max(kBrakeShare * most - kGravity_mps2 * downhill, most / 4);
}

void SpeedProfile::brake_and_accelerate(double speed_mps, std::vector<TrajectoryPoint>& trajectory) {
  for (std::size_t i = trajectory.size() - 1; i > 0; --i) {
    const double next_mps = trajectory[i].speed_mps;
    const double can_mps = std::sqrt(next_mps * next_mps + 2 * brake_mps2(trajectory[i - 1]) * kStep_m);
    if (can_mps >= trajectory[i - 1].speed_mps) continue;
    trajectory[i - 1].speed_mps = can_mps;
    limits_.reasons[i - 1] = limits_.reasons[i];
    limits_.reason_places_m[i - 1] = limits_.reason_places_m[i];
  }
  double can_mps = std::max(0.0, speed_mps);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    can_mps = std::sqrt(can_mps * can_mps + 2 * config_.vehicle.max_accel_mps2 * kStep_m);
    can_mps = trajectory[i].speed_mps = std::min(can_mps, trajectory[i].speed_mps);
  }
}

void brake_along(double speed_mps, double decel_mps2, std::vector<TrajectoryPoint>& trajectory) {
  double square = speed_mps * speed_mps;
  for (TrajectoryPoint& point : trajectory) {
    point.speed_mps = std::sqrt(square);
    square = std::max(0.0, square - 2 * decel_mps2 * kStep_m);
  }
}

double speed_at(const std::vector<TrajectoryPoint>& trajectory, double along_m) {
  const double place = std::clamp(along_m / kStep_m, 0.0, static_cast<double>(trajectory.size() - 1));
  const auto before = static_cast<std::size_t>(place);
  const std::size_t after = std::min(before + 1, trajectory.size() - 1);
  const double share = place - static_cast<double>(before);
  return (1 - share) * trajectory[before].speed_mps + share * trajectory[after].speed_mps;
}

}  // namespace gvom::planner
