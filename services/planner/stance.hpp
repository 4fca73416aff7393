// How the vehicle stands on the ground of the map.
#pragma once

#include "services/common/planner_config.hpp"
#include "services/planner/map_view.hpp"

namespace gvom::planner {

/// The plane that four wheels stand on: least squares through the ground under them, as if the suspension
/// shared out what the four do not agree about. Angles as in REP-103: roll is positive with the left side up,
/// pitch with the nose down.
struct Stance {
  bool known = false;  ///< Ground is known under all wheels; else the rest is 0.
  double z_m = 0;      ///< Of the plane under base_link, in odom.
  double roll_rad = 0;
  double pitch_rad = 0;
  double belly_m = 0;  ///< How far the highest ground between the wheels is above the plane; at least 0.
};

/// Height of the ground in odom, bilinear between the middles of those of the four nearest cells that know
/// it; NaN where the cell that holds the place does not.
double height_at(const MapView& map, double x_m, double y_m);

Stance stance_at(const MapView& map, const VehicleLimits& vehicle, const Pose2& pose);

/// The largest share that a stance takes of a limit: of roll, pitch or ground clearance. 0 where unknown.
double strain_of(const Stance& stance, const VehicleLimits& vehicle);

/// Whether it would tip or sit on its belly there. What is not known is not bad.
inline bool is_bad(const Stance& stance, const VehicleLimits& vehicle) {
  return strain_of(stance, vehicle) > 1;
}

/// The roughest ground (R12, m^2) under a wheel; 0 where none is known.
double roughness_at(const MapView& map, const VehicleLimits& vehicle, const Pose2& pose);

}  // namespace gvom::planner
