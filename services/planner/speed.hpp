// How fast a trajectory may be driven, and why not faster.
#pragma once

#include <vector>

#include "services/planner/map_view.hpp"
#include "services/planner/planner.hpp"

namespace gvom::planner {

/// What ends a trajectory, at its last point.
enum class End { goal, blocked, horizon };

struct SpeedLimits {
  double creeps_to_m = 0;               ///< It creeps up to here, `kCreepTo_m` before what is not seen.
  std::vector<Reason> reasons;          ///< Of each point: why it is not faster there.
  std::vector<double> reason_places_m;  ///< Where along the trajectory that is.
};

/// Sets the speed at each point of a trajectory to the least of:
/// - what is commanded;
/// - curve: sqrt(lateral / |curvature|), and such that the curvature changes no faster than it can;
/// - rough: bumps of height s = sqrt(roughness), kBump_m long, lift it by no more than kVertical_mps2:
///   v = kBump_m / (2 pi) * sqrt(kVertical_mps2 / s);
/// - steep: from half of the vehicle's limit of roll or pitch on falling linearly to creep_mps at the limit;
/// - unseen ground: v * latency + v^2 / (2 a) <= seen_m - kUnseenMargin_m - s; but it creeps up to
///   `creeps_to_m`;
/// - what the points ahead need if it brakes by a, and the point behind if it accelerates by max_accel; the
///   last point is stopped at.
/// a is kBrakeShare of max_decel, less gravity's part downhill, at least a quarter of max_decel.
class SpeedProfile {
 public:
  static constexpr double kBump_m = 4;
  static constexpr double kVertical_mps2 = 3;
  static constexpr double kUnseenMargin_m = 2;
  static constexpr double kCreepTo_m = 1;
  static constexpr double kBrakeShare = 0.8;

  /// @param most_points of a trajectory
  SpeedProfile(const PlannerConfig& config, std::size_t most_points);

  /// @param speed_mps now, at the first point
  /// @param seen_m so far along the trajectory it is over known ground
  const SpeedLimits& make(const MapView& map, double speed_mps, double seen_m, End end,
                          std::vector<TrajectoryPoint>& trajectory);

 private:
  void limit(std::size_t i, double speed_mps, Reason reason, std::vector<TrajectoryPoint>& trajectory);
  void limit_by_ground(const MapView& map, std::vector<TrajectoryPoint>& trajectory);
  void limit_by_curves(std::vector<TrajectoryPoint>& trajectory);
  void limit_by_sight(double seen_m, std::vector<TrajectoryPoint>& trajectory);
  void limit_by_end(End end, std::vector<TrajectoryPoint>& trajectory);
  void brake_and_accelerate(double speed_mps, std::vector<TrajectoryPoint>& trajectory);
  [[nodiscard]] double brake_mps2(const TrajectoryPoint& at) const;

  PlannerConfig config_;
  SpeedLimits limits_;
};

/// Sets the speed at each point to what is left when the vehicle brakes from the first one on.
void brake_along(double speed_mps, double decel_mps2, std::vector<TrajectoryPoint>& trajectory);

/// The speed so far along a trajectory, linear between its points.
double speed_at(const std::vector<TrajectoryPoint>& trajectory, double along_m);

}  // namespace gvom::planner
