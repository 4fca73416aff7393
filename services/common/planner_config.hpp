// The vehicle as a planner knows it, and what can be configured about planning. Default, unit, range and
// meaning stand on each field; the YAML keys carry the fields' names.
#pragma once

namespace gvom::planner {

enum class Steering {
  ackermann,   ///< Front wheels turn: no turn tighter than `max_curvature_per_m`.
  skid_steer,  ///< The sides turn at speeds of their own. It is driven like a car that turns tightly.
};

/// `vehicle.*` of the vehicle file. base_link is in the middle of the wheels of a skid-steer vehicle, at the
/// middle of the rear axle of an Ackermann one: what turns about it has no sideways speed.
struct VehicleLimits {
  Steering steering = Steering::skid_steer;
  double front_m = 0.8;       ///< From base_link to the bumper, 0.1 .. 20.
  double rear_m = 0.8;        ///< From base_link backwards, 0.1 .. 20.
  double width_m = 1.4;       ///< 0.1 .. 10.
  double height_m = 1.8;      ///< Of the highest part above the ground, 0.1 .. 10: what hangs lower is hit.
  double front_axle_m = 0.5;  ///< Ahead of base_link, 0 .. 20.
  double rear_axle_m = 0.5;   ///< Behind base_link, 0 .. 20.
  double track_m = 1.1;       ///< Between the wheels' middles, left to right, 0.1 .. 10.
  double ground_clearance_m = 0.25;         ///< Under the belly, between the wheels, 0.01 .. 2.
  double max_curvature_per_m = 0.7;         ///< 0.01 .. 10.
  double max_curvature_rate_per_m_s = 1.0;  ///< How fast it changes, 0.01 .. 100.
  double max_speed_mps = 5.0;               ///< 0.1 .. 40.
  double max_accel_mps2 = 1.5;              ///< 0.1 .. 10.
  double max_decel_mps2 = 2.5;              ///< That it can rely on, on loose ground, 0.1 .. 10.
  double max_lateral_accel_mps2 = 2.0;      ///< 0.1 .. 10.
  double max_roll_rad = 0.40;               ///< 0.01 .. 1.5.
  double max_pitch_rad = 0.50;              ///< 0.01 .. 1.5.
  double latency_s = 0.3;                   ///< From what the lidar saw to what the wheels do, 0 .. 5.

  [[nodiscard]] double length_m() const { return front_m + rear_m; }
};

/// How layers become cost. Cost is per metre, 1 on good ground; weights are what is added at full value.
struct CostmapConfig {
  double slope_weight = 4.0;        ///< At `slope_full_rad`, 0 .. 1000.
  double roughness_weight = 6.0;    ///< At `roughness_full_m2`, 0 .. 1000.
  double soft_weight = 16.0;        ///< Over a SOFT column, falling to 0 at the sides of it, 0 .. 1000.
  double unknown_cost = 0.5;        ///< Added where no ground is known, 0 .. 1000; speed is bounded by sight.
  double remembered_cost = 1.0;     ///< Added where ground is remembered (R17), 0 .. 1000.
  double slope_full_rad = 0.4;      ///< 0.01 .. 1.5.
  double roughness_full_m2 = 0.02;  ///< 0.0001 .. 10.
  double near_weight = 10.0;        ///< Added beside what is lethal, 0 .. 1000,
  double near_m = 1.0;              ///< falling to nothing within this distance of the footprint, 0.1 .. 20.
  double margin_m = 0.2;            ///< No part of the vehicle is nearer to what is lethal, 0 .. 5.
  double gap_m = 1.2;  ///< Between known ground on both sides ground counts as seen, 0 .. 5: rings of beams.
};

struct PlannerConfig {
  VehicleLimits vehicle;
  CostmapConfig costmap;
  double speed_mps = 4.5;         ///< That is commanded where nothing forbids it, 0.1 .. 40.
  double creep_mps = 0.5;         ///< Where the ground ahead is not seen but may be soon, 0.05 .. 5.
  double goal_tolerance_m = 1.5;  ///< A waypoint is reached within this distance, 0.1 .. 50.
  double horizon_m = 20.0;        ///< Length of the path that is optimised, 2 .. 100.
  double max_age_s = 0.5;         ///< Of layers that are driven by, 0.05 .. 10.
  double rate_hz = 10.0;          ///< Of planning cycles, 1 .. 100.
  double give_up_s = 60.0;        ///< Without coming nearer to the goal, 1 .. 3600.
  double back_out_m = 6.0;        ///< The farthest that it backs at a time, 0 .. 50.
  double blind_m = 3.0;           ///< Nearer to base_link its lidars may see no ground, 0 .. 20.
};

}  // namespace gvom::planner
