// How the vehicle is kept on its trajectory.
#pragma once

#include <vector>

#include "services/planner/planner.hpp"

namespace gvom::planner {

/// What a vehicle will be when a command takes effect.
struct Predicted {
  Pose2 pose;
  double speed_mps = 0;
  double curvature_per_m = 0;
};

/// iLQR over `kSteps` periods, as in the paper: states are the lateral error, the heading error and the
/// curvature, the control is the rate of the curvature; the speed is the trajectory's. The curvature is a
/// state because steering is slow: a law that commands curvature at will asks for what the actuators cannot
/// do and swings at speed; this one begins to steer before the curve. It is iLQR and not LQR because errors
/// grow by sin(heading error) and because the limits of the control are kept in each roll-out. The number of
/// iterations is fixed: so is the time, and what it answers does not depend on a threshold.
///
/// @param trajectory its first points are beside the vehicle; its speeds are set
/// @return the curvature to command for the next period
double follow(const PlannerConfig& config, const Predicted& vehicle,
              const std::vector<TrajectoryPoint>& trajectory);

}  // namespace gvom::planner
