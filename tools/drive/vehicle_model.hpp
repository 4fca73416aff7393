// What a simulated vehicle is beside the limits that its planner knows: actuators, wheels, slip.
#pragma once

#include <cmath>

#include "services/common/planner_config.hpp"

namespace gvom::driving {

inline constexpr double kGravity_mps2 = 9.81;

struct VehicleModel {
  planner::VehicleLimits limits;
  double base_height_m = 0.25;  ///< Of base_link above the ground (R9).
  double wheel_radius_m = 0.3;
  double wheel_width_m = 0.25;
  double centre_of_mass_m = 0.5;    ///< Above the ground.
  double delay_s = 0.1;             ///< From a command to the actuators' begin.
  double speed_memory_s = 0.2;      ///< Time constant of the drive,
  double curvature_memory_s = 0.1;  ///< and of the steering.
  double command_lasts_s = 0.5;     ///< After so long without a new command it brakes.
  double turn_slip = 0.1;           ///< Part of its yaw rate that a skid-steer vehicle loses.
  double climb_slip = 0.3;          ///< Part of its speed that it loses uphill, times the sine of the slope.
  double side_slip = 0.1;           ///< Of its speed it slides down across a slope, times the slope's sine.
  double grip = 0.6;                ///< Of wheels on the ground: force over weight.

  /// Beyond it, it tips over its front or rear axle.
  [[nodiscard]] double tip_pitch_rad() const {
    return std::atan(0.5 * (limits.front_axle_m + limits.rear_axle_m) / centre_of_mass_m);
  }
  [[nodiscard]] double wheel_base_m() const { return limits.front_axle_m + limits.rear_axle_m; }
};

}  // namespace gvom::driving
