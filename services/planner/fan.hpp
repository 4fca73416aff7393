// What the vehicle could drive now: trajectories simulated over the map, and the cheapest of them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "services/planner/costmap.hpp"
#include "services/planner/optimiser.hpp"
#include "services/planner/planner.hpp"
#include "services/planner/sight.hpp"
#include "services/planner/stance.hpp"

namespace gvom::planner {

/// A trajectory that was simulated: points `Fan::kStep_m` apart, each with the pose, the stance and the
/// curvature from there to the next.
struct Trajectory {
  std::vector<TrajectoryPoint> points;
  double cost = 0;
  bool blocked = false;  ///< It ends because the next pose hits something or tips.
  bool reached = false;  ///< It passes the waypoint; where that is the last, it ends there.
  /// It is not blocked, or the cost to go is less at its end than at its start, or it is `kRoomToTurn_m` long
  /// and that and turning is less. A short turn in a narrow lane leads nowhere.
  bool leads_on = false;
  double seen_m = 0;  ///< Of its length, all that is over known ground (`Sight`).
};

/// What a fan is simulated over. All places in odom.
struct FanInput {
  const MapView* map = nullptr;
  const Costmap* costs = nullptr;
  const float* cost_to_go = nullptr;             ///< Of the costmap's cells, to `waypoint_m`.
  const std::vector<PathPoint>* path = nullptr;  ///< Optimised, from the vehicle on.
  Eigen::Vector2d waypoint_m = Eigen::Vector2d::Zero();
  const Eigen::Vector2d* next_m = nullptr;  ///< The waypoint after it; nullptr: it is the last.
  const float* next_cost_to_go =
      nullptr;  ///< To that; nullptr: it is too far away to matter, or no way is known.
  Pose2 pose;
  double curvature_per_m = 0;
  double speed_mps = 0;
};

/// Each trajectory holds a curvature for a while and then pursues the optimised path, or drives the path's
/// own curvatures, at one of three speeds: the slower ones may turn more tightly and steer more per metre,
/// and go on as fast as their bends allow. Ackermann and skid-steer differ by their limits only: a skid-steer
/// vehicle that turns on the spot tears up the ground and its odometry.
///
/// A trajectory ends before the first pose that does not fit or whose stance is bad. A vehicle that stands so
/// may leave: on its first `kLeave_m` no pose may be worse than where it stands.
///
/// The cost is the costmap's along it, `kPerSecond` for its time, and what is left to pay at its end: the
/// cost to go with its time at the speed that is asked for, and turning from there into its direction; near
/// the last waypoint also the way out of a turning circle that it lies within. One that ends early pays more,
/// one that leads nowhere still more, and one that cannot stop before its end or within what is seen most.
/// What was chosen last goes on a little cheaper.
class Fan {
 public:
  static constexpr double kStep_m = 0.25;
  static constexpr double kHorizon_m = 12;
  static constexpr double kShortest_m = 0.75;  ///< Nothing shorter is worth driving.

  static constexpr double kLeave_m = 2;
  static constexpr double kRoomToTurn_m = 3;

  explicit Fan(const PlannerConfig& config);

  /// The cheapest trajectory, the first of equals; nullptr: none can be driven. Valid until the next run.
  const Trajectory* choose(const FanInput& input);
  /// What was chosen last does not go on.
  void forget() { best_.points.clear(); }

  /// How far it looks at a speed: `kHorizon_m`, or what it takes to stop.
  [[nodiscard]] double reach_m(double speed_mps) const;
  /// No trajectory has more.
  [[nodiscard]] std::size_t most_points() const;

 private:
  struct Inputs {
    double speed_mps = 0;        ///< That it slows down or accelerates to.
    double hold_m = 0;           ///< For so long it holds
    double curvature_per_m = 0;  ///< this.
    bool replays_path = false;
  };
  /// Of the trajectory that is being simulated.
  struct Progress {
    Pose2 pose;
    double curvature_per_m = 0;
    double speed_mps = 0;
    std::size_t on_path = 0;  ///< The path's point that it is nearest to.
  };

  void list_inputs();
  void look_at_start(const FanInput& input);
  void begin();
  void go_on_with_last(const FanInput& input);
  void drive(const FanInput& input, const Inputs& inputs, Progress at);
  bool append(const FanInput& input, const TrajectoryPoint& at, double speed_mps);
  [[nodiscard]] bool is_free(const FanInput& input, const Pose2& pose, const Stance& stance) const;
  bool arrives(const FanInput& input, const Pose2& pose);
  [[nodiscard]] double stop_cost(const FanInput& input, double length_m) const;
  void finish(const FanInput& input, double factor);
  [[nodiscard]] double curvature_of(const FanInput& input, const Inputs& inputs, Progress& at) const;
  [[nodiscard]] double target_mps(const Inputs& inputs, double want_per_m) const;
  [[nodiscard]] double towards(double speed_mps, double target_mps) const;
  [[nodiscard]] double to_go(const FanInput& input, const Pose2& from, bool reached) const;
  [[nodiscard]] double turning(const FanInput& input, const Pose2& from, bool reached) const;
  [[nodiscard]] std::size_t steps(double speed_mps) const;

  PlannerConfig config_;
  Sight sight_;
  std::vector<Inputs> inputs_;
  Trajectory now_, best_, last_;
  double start_strain_ = 1;  ///< More is bad: 1, or what it stands with, if that is more.
  double start_room_m_ = 0;  ///< If it stands where it does not fit: how near to what it would hit.
  bool start_fits_ = true;
  bool sees_ = true;  ///< All of this trajectory so far.
  double start_to_go_ = 0;
  double start_turning_ = 0;
  double cruise_mps_ = 0;
  double timed_ = 1;  ///< What a metre of good ground costs with its time, at the speed that is asked for.
};

}  // namespace gvom::planner
