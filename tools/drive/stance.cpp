#include "tools/drive/stance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gvom::driving {
namespace {

constexpr double kBellyStep_m = 0.1;
constexpr int kTreadSteps = 6;  // samples of a wheel before and behind its axle

Eigen::Vector2d to_odom(const planner::Pose2& place, double ahead_m, double left_m) {
  const Eigen::Vector2d forward = place.forward();
  return place.place() + ahead_m * forward + left_m * Eigen::Vector2d(-forward.y(), forward.x());
}

/// Where a wheel touches the ground.
struct Touch {
  double wheel_m = -std::numeric_limits<double>::infinity();  ///< Its lowest point.
  double ground_m = 0;                                        ///< What it touches.
  bool is_firm = true;
};

/// The wheel is lowered on what is below it, so an edge holds it until its whole tread is beyond.
Touch lower_wheel(const sim::Terrain& terrain, const VehicleModel& model, const planner::Pose2& place,
                  double ahead_m, double left_m) {
  const double radius_m = model.wheel_radius_m;
  Touch touch;
  for (int along = -kTreadSteps; along <= kTreadSteps; ++along) {
    const double shift_m = radius_m * along / kTreadSteps;
    const double curved_m = radius_m - std::sqrt(radius_m * radius_m - shift_m * shift_m);
    for (int across = -1; across <= 1; ++across) {
      const Eigen::Vector2d at =
          to_odom(place, ahead_m + shift_m, left_m + 0.5 * across * model.wheel_width_m);
      const double ground_m = terrain.height_m(at.x(), at.y());
      if (ground_m - curved_m <= touch.wheel_m) continue;
      touch = {ground_m - curved_m, ground_m, terrain.is_sound(at.x(), at.y())};
    }
  }
  return touch;
}

/// Rise over run of the wheels' plane, forwards and to the left.
Eigen::Vector2d slope_of(const Stance& stance) {
  return {-std::tan(stance.pitch_rad), std::tan(stance.roll_rad)};
}

}  // namespace

Stance stand(const sim::Terrain& terrain, const VehicleModel& model, const planner::Pose2& place) {
  const planner::VehicleLimits& limits = model.limits;
  Stance stance;
  for (int wheel = 0; wheel < kWheels; ++wheel) {
    const bool is_front = wheel == kFrontLeft || wheel == kFrontRight;
    const bool is_left = wheel == kFrontLeft || wheel == kRearLeft;
    const double ahead_m = is_front ? limits.front_axle_m : -limits.rear_axle_m;
    const double left_m = (is_left ? 0.5 : -0.5) * limits.track_m;
    const Touch touch = lower_wheel(terrain, model, place, ahead_m, left_m);
    stance.wheel_m[wheel] = touch.wheel_m;
    stance.touched_m[wheel] = touch.ground_m;
    stance.is_firm[wheel] = touch.is_firm;
  }
  const auto& wheels = stance.wheel_m;
  const double front_m = 0.5 * (wheels[kFrontLeft] + wheels[kFrontRight]);
  const double rear_m = 0.5 * (wheels[kRearLeft] + wheels[kRearRight]);
  const double left_m = 0.5 * (wheels[kFrontLeft] + wheels[kRearLeft]);
  const double right_m = 0.5 * (wheels[kFrontRight] + wheels[kRearRight]);
  stance.pitch_rad = -std::atan((front_m - rear_m) / model.wheel_base_m());
  stance.roll_rad = std::atan((left_m - right_m) / limits.track_m);
  stance.ground_m = rear_m + (front_m - rear_m) * limits.rear_axle_m / model.wheel_base_m();
  return stance;
}

double belly_ground_m(const sim::Terrain& terrain, const VehicleModel& model, const planner::Pose2& place,
                      const Stance& stance) {
  const planner::VehicleLimits& limits = model.limits;
  const Eigen::Vector2d slope = slope_of(stance);
  const double half_width_m = 0.5 * (limits.track_m - model.wheel_width_m);
  const auto steps = [](double length_m) { return std::max(1, static_cast<int>(length_m / kBellyStep_m)); };
  const int along = steps(model.wheel_base_m()), across = steps(2 * half_width_m);
  double highest_m = -std::numeric_limits<double>::infinity();
  for (int i = 0; i <= along; ++i)
    for (int k = 0; k <= across; ++k) {
      const Eigen::Vector2d at(-limits.rear_axle_m + model.wheel_base_m() * i / along,
                               half_width_m * (2.0 * k / across - 1.0));
      const Eigen::Vector2d point = to_odom(place, at.x(), at.y());
      const double plane_m = stance.ground_m + slope.dot(at);
      highest_m = std::max(highest_m, terrain.height_m(point.x(), point.y()) - plane_m);
    }
  return highest_m;
}

Pose pose_of(const VehicleModel& model, const planner::Pose2& place, const Stance& stance) {
  Pose pose;
  pose.translation_m = {place.x_m, place.y_m, stance.ground_m + model.base_height_m};
  pose.rotation = Eigen::AngleAxisd(place.yaw_rad, Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(stance.pitch_rad, Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(stance.roll_rad, Eigen::Vector3d::UnitX());
  return pose;
}

}  // namespace gvom::driving
