#include "services/planner/fan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/planner/arc.hpp"
#include "services/planner/room.hpp"
#include "services/planner/search.hpp"
#include "services/planner/speed.hpp"

namespace gvom::planner {
namespace {

using Eigen::Vector2d;

constexpr double kPerSecond = 3;        // of driving, in metres of good ground
constexpr double kPerMissingMetre = 4;  // of the reach, where it ends early
constexpr double kCannotStop = 1000;    // where it ends at once, less the more of the way to stop there is
constexpr double kLeadsNowhere = 500;
constexpr double kUnreached = 1000;      // an end that the search knows no way from
constexpr double kLastIsCheaper = 0.97;  // hysteresis
constexpr double kHolds_m[] = {1.5, 3};
constexpr double kSlow_mps = 1.5;
constexpr double kSlowFor_m = 3;          // after what it holds; then it may drive as fast as its bends allow
constexpr double kSteeringBelow_mps = 1;  // below it, steering is simulated as at it
constexpr double kAim = 0.75;             // of the tolerance: who aims at its rim misses it by a slip
constexpr double kSlips = 1.15;           // wider than the tightest turn may one be that it is told to drive
constexpr double kPerMetreWithin = 4;     // of the way out of a turning circle with the last waypoint in it

/// Bilinear between those of the four nearest cells that a way is known from; +infinity: none.
double cost_at(const Cells& cells, const float* cost, const Vector2d& place_m) {
  const double x = (place_m.x() - cells.x_m) / cells.cell_m - 0.5;
  const double y = (place_m.y() - cells.y_m) / cells.cell_m - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  double sum = 0, weights = 0;
  for (int dy = 0; dy < 2; ++dy)
    for (int dx = 0; dx < 2; ++dx) {
      if (!cells.contains(x0 + dx, y0 + dy)) continue;
      const double value = cost[(y0 + dy) * cells.n + x0 + dx];
      if (!std::isfinite(value)) continue;
      const double weight = (1 - std::abs(x - (x0 + dx))) * (1 - std::abs(y - (y0 + dy)));
      sum += weight * value;
      weights += weight;
    }
  return weights > 1e-9 ? sum / weights : kLethalCost;
}

/// The angle between a heading and the way in which the cost to go falls; 0 where that isn't known.
double turn_rad(const Cells& cells, const float* cost, const Pose2& end) {
  const double off_m = 2 * cells.cell_m;
  const auto at = [&](double dx_m, double dy_m) {
    return cost_at(cells, cost, end.place() + Vector2d(dx_m, dy_m));
  };
  const Vector2d falls(at(-off_m, 0) - at(off_m, 0), at(0, -off_m) - at(0, off_m));
  if (!falls.allFinite() || falls.squaredNorm() < 1e-6) return 0;
  return std::abs(wrapped(std::atan2(falls.y(), falls.x()) - end.yaw_rad));
}

}  // namespace

Fan::Fan(const PlannerConfig& config) : config_(config), sight_(config.vehicle) {
  list_inputs();
  for (Trajectory* trajectory : {&now_, &best_, &last_}) trajectory->points.reserve(most_points());
}

void Fan::list_inputs() {
  const VehicleLimits& vehicle = config_.vehicle;
  cruise_mps_ = std::min(config_.speed_mps, vehicle.max_speed_mps);
  timed_ = 1 + kPerSecond / cruise_mps_;
  for (const double speed_mps : {cruise_mps_, cruise_mps_ / 2, std::min(kSlow_mps, cruise_mps_)}) {
    const double most_per_m =
        std::min(vehicle.max_curvature_per_m, vehicle.max_lateral_accel_mps2 / (speed_mps * speed_mps));
    inputs_.push_back({speed_mps, 0, 0, false});
    for (const double hold_m : kHolds_m)
      for (int i = -4; i <= 4; ++i)
        inputs_.push_back({speed_mps, hold_m, most_per_m * i * std::abs(i) / 16, false});
  }
  inputs_.push_back({cruise_mps_, 0, 0, true});
}

double Fan::reach_m(double speed_mps) const {
  const VehicleLimits& vehicle = config_.vehicle;
  const double soon_mps = speed_mps + vehicle.max_accel_mps2;  // what it is in a second
  return std::max(kHorizon_m, soon_mps * vehicle.latency_s + soon_mps * soon_mps / vehicle.max_decel_mps2);
}

std::size_t Fan::steps(double speed_mps) const {
  return static_cast<std::size_t>(
      std::ceil(reach_m(std::min(speed_mps, 2 * config_.vehicle.max_speed_mps)) / kStep_m));
}

std::size_t Fan::most_points() const {
  return steps(2 * config_.vehicle.max_speed_mps) + 2;
}

const Trajectory* Fan::choose(const FanInput& input) {
  look_at_start(input);
  std::swap(best_, last_);
  best_.points.clear();
  best_.cost = kLethalCost;
  go_on_with_last(input);
  for (const Inputs& inputs : inputs_) {
    begin();
    drive(input, inputs, {input.pose, input.curvature_per_m, input.speed_mps, 0});
    finish(input, 1);
  }
  return best_.points.empty() ? nullptr : &best_;
}

void Fan::look_at_start(const FanInput& input) {
  const VehicleLimits& vehicle = config_.vehicle;
  start_strain_ = std::max(1.0, strain_of(stance_at(*input.map, vehicle, input.pose), vehicle));
  start_fits_ = input.costs->fits(input.pose);
  start_to_go_ = to_go(input, input.pose, false) * timed_;
  start_turning_ = turning(input, input.pose, false);
  if (!start_fits_) start_room_m_ = room_m(*input.costs, vehicle, input.pose);
}

bool Fan::is_free(const FanInput& input, const Pose2& pose, const Stance& stance) const {
  const bool leaves = (pose.place() - input.pose.place()).norm() <= kLeave_m;
  if (strain_of(stance, config_.vehicle) > (leaves ? start_strain_ : 1)) return false;
  return input.costs->fits(pose) ||
         (leaves && !start_fits_ && gets_no_nearer(*input.costs, config_.vehicle, pose, start_room_m_));
}

void Fan::begin() {
  now_.points.clear();
  now_.cost = 0;
  now_.blocked = now_.reached = now_.leads_on = false;
  now_.seen_m = 0;
  sees_ = true;
}

void Fan::go_on_with_last(const FanInput& input) {
  std::size_t nearest = 0;
  const auto away_m = [&](std::size_t i) {
    return (last_.points[i].pose.place() - input.pose.place()).norm();
  };
  for (std::size_t i = 1; i < last_.points.size(); ++i)
    if (away_m(i) < away_m(nearest)) nearest = i;
  if (nearest + 1 >= last_.points.size() || away_m(nearest) > 2 * kStep_m ||
      std::abs(wrapped(last_.points[nearest].pose.yaw_rad - input.pose.yaw_rad)) > 0.2)
    return;
  begin();
  Progress at;
  at.speed_mps = input.speed_mps;
  for (std::size_t i = nearest; i + 1 < last_.points.size(); ++i)
    if (!append(input, last_.points[i], input.speed_mps)) return finish(input, kLastIsCheaper);
  at.pose = last_.points.back().pose;
  at.curvature_per_m = last_.points[last_.points.size() - 2].curvature_per_m;
  drive(input, {std::max(input.speed_mps, kSlow_mps), 0, 0, false}, at);
  finish(input, kLastIsCheaper);
}

void Fan::drive(const FanInput& input, const Inputs& inputs, Progress at) {
  const VehicleLimits& vehicle = config_.vehicle;
  const std::size_t count = steps(input.speed_mps);
  const double most_per_m = vehicle.max_curvature_per_m;
  at.curvature_per_m = std::clamp(at.curvature_per_m, -most_per_m, most_per_m);
  while (now_.points.size() <= count && now_.cost < best_.cost) {
    const double limit_per_m =
        std::min(most_per_m, vehicle.max_lateral_accel_mps2 / std::max(at.speed_mps * at.speed_mps, 1e-3));
    const double want_per_m = std::clamp(curvature_of(input, inputs, at), -limit_per_m, limit_per_m);
    const double change_per_m =
        vehicle.max_curvature_rate_per_m_s * kStep_m / std::max(at.speed_mps, kSteeringBelow_mps);
    at.curvature_per_m =
        std::clamp(want_per_m, at.curvature_per_m - change_per_m, at.curvature_per_m + change_per_m);
    TrajectoryPoint point;
    point.pose = at.pose;
    point.curvature_per_m = at.curvature_per_m;
    if (!append(input, point, at.speed_mps)) return;
    at.pose = moved(at.pose, kStep_m, at.curvature_per_m);
    at.speed_mps = towards(at.speed_mps, target_mps(inputs, want_per_m));
  }
}

double Fan::target_mps(const Inputs& inputs, double want_per_m) const {
  const double driven_m = static_cast<double>(now_.points.size()) * kStep_m;
  if (driven_m < inputs.hold_m + kSlowFor_m) return inputs.speed_mps;
  const VehicleLimits& vehicle = config_.vehicle;
  const double bend_mps = std::sqrt(vehicle.max_lateral_accel_mps2 / std::max(std::abs(want_per_m), 1e-3));
  return std::max(inputs.speed_mps, std::min(cruise_mps_, bend_mps));
}

double Fan::towards(double speed_mps, double target_mps) const {
  const double square = speed_mps * speed_mps;
  if (speed_mps < target_mps)
    return std::min(target_mps, std::sqrt(square + 2 * config_.vehicle.max_accel_mps2 * kStep_m));
  const double brakes = 1.4 * config_.vehicle.max_decel_mps2 * kStep_m;
  return std::max(target_mps, std::sqrt(std::max(0.0, square - brakes)));
}

double Fan::curvature_of(const FanInput& input, const Inputs& inputs, Progress& at) const {
  const double driven_m = static_cast<double>(now_.points.size()) * kStep_m;
  if (driven_m < inputs.hold_m) return inputs.curvature_per_m;
  const std::vector<PathPoint>& path = *input.path;
  if (path.empty()) return 0;
  if (inputs.replays_path && driven_m < static_cast<double>(path.size() - 1) * PathOptimiser::kStep_m)
    return path[static_cast<std::size_t>(driven_m / PathOptimiser::kStep_m)].curvature_per_m;
  const auto away_m = [&](std::size_t i) { return (path[i].pose.place() - at.pose.place()).norm(); };
  while (at.on_path + 1 < path.size() && away_m(at.on_path + 1) <= away_m(at.on_path)) ++at.on_path;
  const double ahead_m = std::max(1.2, 0.6 * at.speed_mps);
  for (std::size_t i = at.on_path; i < path.size(); ++i)
    if (away_m(i) >= ahead_m) return curvature_to(at.pose, path[i].pose.place());
  const Pose2& end = path.back().pose;
  return curvature_to(at.pose, end.place() + ahead_m * end.forward());
}

bool Fan::append(const FanInput& input, const TrajectoryPoint& at, double speed_mps) {
  const Stance stance = stance_at(*input.map, config_.vehicle, at.pose);
  now_.blocked = !is_free(input, at.pose, stance);
  if (now_.blocked) return false;
  const double z_m = stance.known ? stance.z_m : std::nan("");
  now_.points.push_back({at.pose, z_m, stance.roll_rad, stance.pitch_rad, at.curvature_per_m, 0});
  const double seconds = kStep_m / std::max(speed_mps, kSteeringBelow_mps);
  now_.cost += kStep_m * input.costs->smooth_cost(at.pose.x_m, at.pose.y_m) + kPerSecond * seconds;
  sees_ = sees_ && sight_.is_known(*input.costs, at.pose, input.pose);
  if (sees_) now_.seen_m = static_cast<double>(now_.points.size() - 1) * kStep_m;
  return !arrives(input, at.pose);
}

bool Fan::arrives(const FanInput& input, const Pose2& pose) {
  const double away_m = (pose.place() - input.waypoint_m).norm();
  if (away_m > kAim * config_.goal_tolerance_m) return false;
  now_.reached = true;
  if (input.next_m != nullptr) return false;
  const bool nears = (input.waypoint_m - pose.place()).dot(pose.forward()) > 0;
  return away_m < kStep_m || !nears;
}

double Fan::to_go(const FanInput& input, const Pose2& from, bool reached) const {
  const Cells& cells = input.costs->cells();
  const auto after = [&](const Vector2d& place) {
    if (input.next_m == nullptr) return Search::kBeyond * (reached ? (place - input.waypoint_m).norm() : 0);
    const double cost =
        input.next_cost_to_go == nullptr ? kLethalCost : cost_at(cells, input.next_cost_to_go, place);
    return std::isfinite(cost) ? cost : Search::kBeyond * (*input.next_m - place).norm();
  };
  if (reached) return after(from.place());
  const double cost = cost_at(cells, input.cost_to_go, from.place());
  const double straight_m = (from.place() - input.waypoint_m).norm();
  return (std::isfinite(cost) ? cost : kUnreached + Search::kBeyond * straight_m) + after(input.waypoint_m);
}

double Fan::turning(const FanInput& input, const Pose2& from, bool reached) const {
  const float* cost_to_go = reached ? input.next_cost_to_go : input.cost_to_go;
  if (cost_to_go == nullptr) return 0;
  const double radius_m = 1 / config_.vehicle.max_curvature_per_m;
  const double turn_m = turn_rad(input.costs->cells(), cost_to_go, from) * radius_m;
  if (reached || input.next_m != nullptr) return turn_m;
  const double around_m = kSlips * radius_m, aim_m = kAim * config_.goal_tolerance_m;
  const Vector2d left_m = around_m * Vector2d(-std::sin(from.yaw_rad), std::cos(from.yaw_rad));
  const Vector2d to_goal_m = input.waypoint_m - from.place();
  const double nearest_m = std::min((to_goal_m - left_m).norm(), (to_goal_m + left_m).norm());
  return turn_m + kPerMetreWithin * std::max(0.0, around_m - aim_m - nearest_m);
}

double Fan::stop_cost(const FanInput& input, double length_m) const {
  const VehicleLimits& vehicle = config_.vehicle;
  const double speed_mps = input.speed_mps;
  const double stop_m = speed_mps * speed_mps / (2 * SpeedProfile::kBrakeShare * vehicle.max_decel_mps2);
  double cost = now_.blocked ? std::max(0.0, 1 - length_m / std::max(stop_m, kStep_m)) : 0;
  if (now_.seen_m < length_m) {
    const double room_m = stop_m + speed_mps * vehicle.latency_s + SpeedProfile::kCreepTo_m;
    cost += std::max(0.0, 1 - now_.seen_m / room_m);
    if (now_.seen_m < SpeedProfile::kCreepTo_m + kStep_m) cost += 1;
  }
  return kCannotStop * cost;
}

void Fan::finish(const FanInput& input, double factor) {
  const double length_m = static_cast<double>(now_.points.size()) * kStep_m - kStep_m;
  const bool arrived = now_.reached && input.next_m == nullptr;
  if (now_.points.empty() || (length_m < kShortest_m && !arrived) || now_.cost >= best_.cost) return;
  const Pose2& end = now_.points.back().pose;
  const double left = to_go(input, end, now_.reached) * timed_;
  const double turn = turning(input, end, now_.reached);
  const double gain = start_to_go_ - left;
  now_.leads_on =
      !now_.blocked || arrived || gain > 0 || (length_m >= kRoomToTurn_m && gain + start_turning_ - turn > 0);
  now_.cost += left + turn + stop_cost(input, length_m);
  if (!now_.leads_on) now_.cost += kLeadsNowhere;
  if (now_.blocked) now_.cost += kPerMissingMetre * std::max(0.0, reach_m(input.speed_mps) - length_m);
  now_.cost *= factor;
  if (now_.cost < best_.cost) std::swap(now_, best_);
}

}  // namespace gvom::planner
