// The rows of what a planner needs: the vehicle's limits, and its own settings.
#include "services/common/config_table.hpp"

namespace gvom::services {

namespace {

using V = VehicleConfig;
constexpr bool kOptional = false;

}  // namespace

std::vector<VehicleRow> limit_rows() {
  return {
      {{"vehicle.steering", "", Rule::steering, 0, 0, kOptional,
        "ackermann: front wheels turn; skid_steer: the sides turn at speeds of their own"},
       [](V& c) -> Field { return &c.planner.vehicle.steering; }},
      {{"vehicle.front_m", "m", Rule::range, 0.1, 20, kOptional, "from base_link to the bumper"},
       [](V& c) -> Field { return &c.planner.vehicle.front_m; }},
      {{"vehicle.rear_m", "m", Rule::range, 0.1, 20, kOptional, "from base_link backwards to its end"},
       [](V& c) -> Field { return &c.planner.vehicle.rear_m; }},
      {{"vehicle.width_m", "m", Rule::range, 0.1, 10, kOptional, "of all that can hit something"},
       [](V& c) -> Field { return &c.planner.vehicle.width_m; }},
      {{"vehicle.height_m", "m", Rule::range, 0.1, 10, kOptional,
        "of its highest part above the ground: what hangs lower is hit"},
       [](V& c) -> Field { return &c.planner.vehicle.height_m; }},
      {{"vehicle.front_axle_m", "m", Rule::range, 0, 20, kOptional, "ahead of base_link"},
       [](V& c) -> Field { return &c.planner.vehicle.front_axle_m; }},
      {{"vehicle.rear_axle_m", "m", Rule::range, 0, 20, kOptional,
        "behind base_link; 0 where base_link is at the rear axle, as of a car"},
       [](V& c) -> Field { return &c.planner.vehicle.rear_axle_m; }},
      {{"vehicle.track_m", "m", Rule::range, 0.1, 10, kOptional,
        "between the wheels' middles, left to right"},
       [](V& c) -> Field { return &c.planner.vehicle.track_m; }},
      {{"vehicle.ground_clearance_m", "m", Rule::range, 0.01, 2, kOptional,
        "under the belly, between the wheels"},
       [](V& c) -> Field { return &c.planner.vehicle.ground_clearance_m; }},
      {{"vehicle.max_curvature_per_m", "1/m", Rule::range, 0.01, 10, kOptional,
        "of the tightest turn that it is to drive"},
       [](V& c) -> Field { return &c.planner.vehicle.max_curvature_per_m; }},
      {{"vehicle.max_curvature_rate_per_m_s", "1/(m s)", Rule::range, 0.01, 100, kOptional,
        "how fast curvature changes"},
       [](V& c) -> Field { return &c.planner.vehicle.max_curvature_rate_per_m_s; }},
      {{"vehicle.max_speed_mps", "m/s", Rule::range, 0.1, 40, kOptional, "of the vehicle"},
       [](V& c) -> Field { return &c.planner.vehicle.max_speed_mps; }},
      {{"vehicle.max_accel_mps2", "m/s^2", Rule::range, 0.1, 10, kOptional, "that a planner may ask for"},
       [](V& c) -> Field { return &c.planner.vehicle.max_accel_mps2; }},
      {{"vehicle.max_decel_mps2", "m/s^2", Rule::range, 0.1, 10, kOptional,
        "that it can rely on, on loose ground: stopping distances come of it"},
       [](V& c) -> Field { return &c.planner.vehicle.max_decel_mps2; }},
      {{"vehicle.max_lateral_accel_mps2", "m/s^2", Rule::range, 0.1, 10, kOptional, "in a turn"},
       [](V& c) -> Field { return &c.planner.vehicle.max_lateral_accel_mps2; }},
      {{"vehicle.max_roll_rad", "rad", Rule::range, 0.01, 1.5, kOptional, "that it stands on"},
       [](V& c) -> Field { return &c.planner.vehicle.max_roll_rad; }},
      {{"vehicle.max_pitch_rad", "rad", Rule::range, 0.01, 1.5, kOptional, "likewise"},
       [](V& c) -> Field { return &c.planner.vehicle.max_pitch_rad; }},
      {{"vehicle.latency_s", "s", Rule::range, 0, 5, kOptional,
        "from what the lidar saw to what the wheels do"},
       [](V& c) -> Field { return &c.planner.vehicle.latency_s; }},
  };
}

std::vector<VehicleRow> planner_rows() {
  return {
      {{"planner.slope_weight", "", Rule::range, 0, 1000, kOptional,
        "added to the cost of a metre, 1 on good ground, at slope_full_rad"},
       [](V& c) -> Field { return &c.planner.costmap.slope_weight; }},
      {{"planner.roughness_weight", "", Rule::range, 0, 1000, kOptional, "likewise, at roughness_full_m2"},
       [](V& c) -> Field { return &c.planner.costmap.roughness_weight; }},
      {{"planner.soft_weight", "", Rule::range, 0, 1000, kOptional,
        "likewise, over a SOFT column, falling to 0 where the vehicle's sides do not touch it"},
       [](V& c) -> Field { return &c.planner.costmap.soft_weight; }},
      {{"planner.unknown_cost", "", Rule::range, 0, 1000, kOptional, "likewise, where no ground is known"},
       [](V& c) -> Field { return &c.planner.costmap.unknown_cost; }},
      {{"planner.remembered_cost", "", Rule::range, 0, 1000, kOptional,
        "likewise, where ground is remembered (R17)"},
       [](V& c) -> Field { return &c.planner.costmap.remembered_cost; }},
      {{"planner.slope_full_rad", "rad", Rule::range, 0.01, 1.5, kOptional, "slope of full cost"},
       [](V& c) -> Field { return &c.planner.costmap.slope_full_rad; }},
      {{"planner.roughness_full_m2", "m^2", Rule::range, 0.0001, 10, kOptional, "roughness of full cost"},
       [](V& c) -> Field { return &c.planner.costmap.roughness_full_m2; }},
      {{"planner.near_weight", "", Rule::range, 0, 1000, kOptional, "added beside what is lethal,"},
       [](V& c) -> Field { return &c.planner.costmap.near_weight; }},
      {{"planner.near_m", "m", Rule::range, 0.1, 20, kOptional,
        "falling to nothing within this distance of the footprint"},
       [](V& c) -> Field { return &c.planner.costmap.near_m; }},
      {{"planner.margin_m", "m", Rule::range, 0, 5, kOptional,
        "no part of the vehicle comes nearer to what is lethal"},
       [](V& c) -> Field { return &c.planner.costmap.margin_m; }},
      {{"planner.gap_m", "m", Rule::range, 0, 5, kOptional,
        "between known ground on both sides ground counts as seen: beams leave rings"},
       [](V& c) -> Field { return &c.planner.costmap.gap_m; }},
      {{"planner.speed_mps", "m/s", Rule::range, 0.1, 40, kOptional,
        "that it drives where nothing forbids it"},
       [](V& c) -> Field { return &c.planner.speed_mps; }},
      {{"planner.creep_mps", "m/s", Rule::range, 0.05, 5, kOptional,
        "where the ground ahead is not seen but may be soon"},
       [](V& c) -> Field { return &c.planner.creep_mps; }},
      {{"planner.goal_tolerance_m", "m", Rule::range, 0.1, 50, kOptional,
        "a waypoint is reached within this distance"},
       [](V& c) -> Field { return &c.planner.goal_tolerance_m; }},
      {{"planner.horizon_m", "m", Rule::range, 2, 100, kOptional, "length of the path that is optimised"},
       [](V& c) -> Field { return &c.planner.horizon_m; }},
      {{"planner.max_age_s", "s", Rule::range, 0.05, 10, kOptional, "of layers that are driven by"},
       [](V& c) -> Field { return &c.planner.max_age_s; }},
      {{"planner.rate_hz", "Hz", Rule::range, 1, 100, kOptional, "of its cycles"},
       [](V& c) -> Field { return &c.planner.rate_hz; }},
      {{"planner.give_up_s", "s", Rule::range, 1, 3600, kOptional, "without coming nearer to the goal"},
       [](V& c) -> Field { return &c.planner.give_up_s; }},
      {{"planner.back_out_m", "m", Rule::range, 0, 50, kOptional, "the farthest that it backs at a time"},
       [](V& c) -> Field { return &c.planner.back_out_m; }},
      {{"planner.blind_m", "m", Rule::range, 0, 20, kOptional,
        "nearer to base_link its lidars may see no ground: what was a hole or SOFT there is that still"},
       [](V& c) -> Field { return &c.planner.blind_m; }},
  };
}

}  // namespace gvom::services
