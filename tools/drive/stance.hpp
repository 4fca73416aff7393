// How a vehicle stands on the ground, with each wheel on what is really below it.
#pragma once

#include <array>

#include "core/pose.hpp"
#include "services/planner/map_view.hpp"
#include "tools/drive/vehicle_model.hpp"
#include "tools/sim/terrain.hpp"

namespace gvom::driving {

enum Wheel { kFrontLeft, kFrontRight, kRearLeft, kRearRight, kWheels };

struct Stance {
  double ground_m = 0;                      ///< Of the wheels' plane at base_link, in odom.
  double roll_rad = 0;                      ///< Positive: the left side is up.
  double pitch_rad = 0;                     ///< Positive: the front is down.
  std::array<double, kWheels> wheel_m{};    ///< The lowest point of each wheel.
  std::array<double, kWheels> touched_m{};  ///< The ground that it touches; at an edge, higher.
  std::array<bool, kWheels> is_firm{};      ///< What it touches is neither of a hole nor of a face.
};

/// Each wheel is lowered on the ground below its tread. Nothing is bridged: a wheel over a hole is in it.
Stance stand(const sim::Terrain& terrain, const VehicleModel& model, const planner::Pose2& place);

/// How far the ground between the wheels reaches above the wheels' plane, metres; below it: negative.
double belly_ground_m(const sim::Terrain& terrain, const VehicleModel& model, const planner::Pose2& place,
                      const Stance& stance);

/// T_odom_base of a vehicle that stands so.
Pose pose_of(const VehicleModel& model, const planner::Pose2& place, const Stance& stance);

}  // namespace gvom::driving
