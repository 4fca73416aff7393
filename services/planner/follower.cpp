#include "services/planner/follower.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "services/planner/arc.hpp"
#include "services/planner/fan.hpp"

namespace gvom::planner {
namespace {

using Eigen::Matrix3d;
using Eigen::RowVector3d;
using Eigen::Vector3d;

constexpr int kSteps = 15;
constexpr int kIterations = 4;
constexpr double kLeast_mps = 0.3;     // slower, steering has no effect to plan with
const Vector3d kStateWeight{4, 4, 1};  // of lateral error, heading error and error of curvature, squared
constexpr double kControlWeight = 0.05;

/// The lateral error (positive: left of the trajectory), the heading error and the curvature.
using States = std::array<Vector3d, kSteps + 1>;
using Controls = std::array<double, kSteps>;

class Tracking {
 public:
  Tracking(const PlannerConfig& config, const Predicted& vehicle,
           const std::vector<TrajectoryPoint>& trajectory)
      : vehicle_(config.vehicle), period_s_(1 / config.rate_hz) {
    const double most_per_m = vehicle_.max_curvature_per_m;
    const std::size_t nearest = nearest_to(vehicle.pose, trajectory);
    const Pose2& at = trajectory[nearest].pose;
    const Eigen::Vector2d off = vehicle.pose.place() - at.place(), forward = at.forward();
    start_ = {forward.x() * off.y() - forward.y() * off.x(), wrapped(vehicle.pose.yaw_rad - at.yaw_rad),
              std::clamp(vehicle.curvature_per_m, -most_per_m, most_per_m)};
    read_reference(static_cast<double>(nearest) + off.dot(forward) / Fan::kStep_m, trajectory);
  }

  double first_curvature() {
    Controls best{};
    States states;
    for (int k = 0; k < kSteps; ++k) best[k] = (curvature_per_m_[k] - start_[2]) / period_s_;
    double least = roll_out(best, states, nullptr, nullptr);
    for (int i = 0; i < kIterations; ++i) {
      Controls now = best;
      States next = states;
      solve(states, best);
      const double cost = roll_out(now, next, &states, &best);
      if (cost >= least) break;
      least = cost;
      best = now;
      states = next;
    }
    return states[1][2];
  }

 private:
  static std::size_t nearest_to(const Pose2& pose, const std::vector<TrajectoryPoint>& trajectory) {
    std::size_t nearest = 0;
    double least_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < std::min<std::size_t>(trajectory.size(), 4); ++i) {
      const double away_m = (trajectory[i].pose.place() - pose.place()).norm();
      if (away_m < least_m) nearest = i, least_m = away_m;
    }
    return nearest;
  }

  // Curvature and speed of the trajectory, period by period.
  void read_reference(double at_steps, const std::vector<TrajectoryPoint>& trajectory) {
    for (int k = 0; k <= kSteps; ++k) {
      const double place = std::clamp(at_steps, 0.0, static_cast<double>(trajectory.size() - 1));
      const TrajectoryPoint& point = trajectory[static_cast<std::size_t>(place)];
      curvature_per_m_[k] = point.curvature_per_m;
      speed_mps_[k] = std::max(point.speed_mps, kLeast_mps);
      at_steps += speed_mps_[k] * period_s_ / Fan::kStep_m;
    }
  }

  [[nodiscard]] Vector3d next(int k, const Vector3d& x, double control) const {
    const double v = speed_mps_[k], reference = curvature_per_m_[k];
    const double along = std::cos(x[1]) / std::max(0.2, 1 - reference * x[0]);
    return {x[0] + period_s_ * v * std::sin(x[1]), x[1] + period_s_ * v * (x[2] - reference * along),
            x[2] + period_s_ * control};
  }

  // Linear about x: its part by the state. That by the control is (0, 0, period).
  [[nodiscard]] Matrix3d by_state(int k, const Vector3d& x) const {
    const double v = speed_mps_[k], reference = curvature_per_m_[k];
    const double room = std::max(0.2, 1 - reference * x[0]);
    Matrix3d a = Matrix3d::Identity();
    a(0, 1) = period_s_ * v * std::cos(x[1]);
    a(1, 0) = -period_s_ * v * reference * reference * std::cos(x[1]) / (room * room);
    a(1, 1) += period_s_ * v * reference * std::sin(x[1]) / room;
    a(1, 2) = period_s_ * v;
    return a;
  }

  [[nodiscard]] Vector3d error(int k, const Vector3d& x) const {
    return {x[0], x[1], x[2] - curvature_per_m_[k]};
  }

  // Riccati's recursion backwards: the change of the control, and how it answers to the state.
  void solve(const States& states, const Controls& controls) {
    Vector3d gradient = kStateWeight.cwiseProduct(error(kSteps, states[kSteps]));
    Matrix3d hessian = kStateWeight.asDiagonal();
    for (int k = kSteps - 1; k >= 0; --k) {
      const Matrix3d a = by_state(k, states[k]);
      const double q_u = kControlWeight * controls[k] + period_s_ * gradient[2];
      const double q_uu = kControlWeight + period_s_ * period_s_ * hessian(2, 2);
      const RowVector3d q_ux = period_s_ * hessian.row(2) * a;
      change_[k] = -q_u / q_uu;
      gain_[k] = -q_ux / q_uu;
      const Vector3d q_x = kStateWeight.cwiseProduct(error(k, states[k])) + a.transpose() * gradient;
      gradient = q_x + q_ux.transpose() * change_[k];
      Matrix3d q_xx = a.transpose() * hessian * a;
      q_xx.diagonal() += kStateWeight;
      hessian = q_xx + q_ux.transpose() * gain_[k];
    }
  }

  // Drives by controls, which it bends to their limits; about `old` ones if there are such, with the gains.
  double roll_out(Controls& controls, States& states, const States* old, const Controls* old_controls) const {
    const double most_per_m = vehicle_.max_curvature_per_m, rate = vehicle_.max_curvature_rate_per_m_s;
    double cost = 0;
    states[0] = start_;
    for (int k = 0; k < kSteps; ++k) {
      if (old != nullptr) controls[k] = (*old_controls)[k] + change_[k] + gain_[k] * (states[k] - (*old)[k]);
      controls[k] = std::clamp(controls[k], -rate, rate);
      controls[k] = std::clamp(controls[k], (-most_per_m - states[k][2]) / period_s_,
                               (most_per_m - states[k][2]) / period_s_);
      const Vector3d off = error(k, states[k]);
      cost += off.dot(kStateWeight.cwiseProduct(off)) + kControlWeight * controls[k] * controls[k];
      states[k + 1] = next(k, states[k], controls[k]);
    }
    const Vector3d off = error(kSteps, states[kSteps]);
    return cost + off.dot(kStateWeight.cwiseProduct(off));
  }

  const VehicleLimits& vehicle_;
  double period_s_;
  Vector3d start_;
  std::array<double, kSteps + 1> curvature_per_m_{}, speed_mps_{};
  std::array<double, kSteps> change_{};
  std::array<RowVector3d, kSteps> gain_{};
};

}  // namespace

double follow(const PlannerConfig& config, const Predicted& vehicle,
              const std::vector<TrajectoryPoint>& trajectory) {
  return Tracking(config, vehicle, trajectory).first_curvature();
}

}  // namespace gvom::planner
