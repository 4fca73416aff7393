// The reference planner, without bus and clock: a map, a state and a course in, a plan out.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/pose.hpp"
#include "services/common/planner_config.hpp"
#include "services/planner/map_view.hpp"
#include "services/planner/optimiser.hpp"

namespace gvom::planner {

/// The vehicle now, by its odometry.
struct State {
  std::int64_t stamp_ns = 0;
  Pose T_odom_base;
  double speed_mps = 0;        ///< Along its heading; negative: backwards.
  double curvature_per_m = 0;  ///< Of the way that it drives; positive: to the left.
};

/// What the map is to be trusted for.
struct Senses {
  double layers_age_s = 0;   ///< Of the data, now.
  bool blind_ahead = false;  ///< No lidar that looks ahead has a map in the window.
  bool blind_behind = false;
  bool odometry_jumped = false;  ///< Since the last cycle.
  double overrun_s = 0;          ///< So long took the last cycle, too long; 0: it did not.
};

enum class Mode : std::uint8_t { drive, creep, back, stop, arrived, gave_up };

/// Why it does not drive as fast as it was asked to. The words are in `words_of`.
enum class Reason : std::uint8_t {
  none,
  no_course,
  no_layers,
  stale_layers,
  blind_side,
  odometry_jump,
  no_odometry,
  overrun,
  no_way,  ///< The search found none.
  goal_in_obstacle,
  stands_in_obstacle,
  no_trajectory,  ///< None of those that can be driven is free.
  unseen_ground,  ///< It can only stop within what is seen by driving slower.
  rough,
  steep,
  curve,
  near_goal,
  mover,     ///< Something that moves may get in its way: it waits.
  dead_end,  ///< Backs out of it.
  no_progress,
};
const char* words_of(Reason reason);

struct Command {
  double speed_mps = 0;  ///< Negative: backwards.
  double curvature_per_m = 0;
};

/// A place on the chosen trajectory, and how fast it may be driven there.
struct TrajectoryPoint {
  Pose2 pose;
  double z_m =
      0;  ///< Of the plane that the wheels stand on, at base_link; where that is not known, as before.
  double roll_rad = 0;
  double pitch_rad = 0;
  double curvature_per_m = 0;
  double speed_mps = 0;
};

/// Valid until the next cycle.
struct Plan {
  static constexpr double kNoWay = std::numeric_limits<double>::infinity();

  Mode mode = Mode::stop;
  Reason reason = Reason::no_course;
  std::string why;  ///< In words, with numbers: what a person reads.
  Command command;
  std::size_t waypoint = 0;                 ///< That it drives to.
  double cost_to_go = kNoWay;               ///< To it, from here.
  double seen_m = 0;                        ///< Along the trajectory, ground that is known.
  std::vector<Eigen::Vector2d> searched;    ///< A*'s path.
  std::vector<PathPoint> path;              ///< The same, optimised.
  std::vector<TrajectoryPoint> trajectory;  ///< Chosen.
};

class Planner {
 public:
  /// @param n_xy the largest map, columns along an edge
  Planner(const PlannerConfig& config, int n_xy);
  ~Planner();

  /// Places in odom to be reached one after the other, from `first` on.
  void set_course(std::vector<Eigen::Vector2d> waypoints_m, std::size_t first = 0);

  /// One cycle, `1 / rate_hz` after the last. Deterministic, without allocations after the first ones.
  /// @param map nullptr: none is there. One larger than `n_xy` is not driven by.
  const Plan& cycle(const MapView* map, const State& state, const Senses& senses);

  /// Instead of a cycle, where nobody knows where the vehicle is: it stands, and steers as before meanwhile.
  /// @param why in words
  const Plan& stand(Reason reason, const char* why);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gvom::planner
