// How near the vehicle's outline is to what it would hit.
#pragma once

#include "services/planner/costmap.hpp"

namespace gvom::planner {

/// From the vehicle's rectangle, without a margin, to the nearest middle of a lethal cell, metres, as far as
/// `kRoomFar_m`; negative: so deep is that inside. For a vehicle that stands nearer than `Costmap::fits`
/// allows and may only drive where it gets no nearer.
double room_m(const Costmap& costs, const VehicleLimits& vehicle, const Pose2& pose);

inline constexpr double kRoomFar_m = 1;

inline bool gets_no_nearer(const Costmap& costs, const VehicleLimits& vehicle, const Pose2& pose,
                           double start_room_m) {
  return room_m(costs, vehicle, pose) >= start_room_m - 0.01;  // rounding on its way around an arc
}

}  // namespace gvom::planner
