// One cycle of the reference planner, step by step.
#pragma once

#include <optional>
#include <vector>

#include "services/planner/closed_places.hpp"
#include "services/planner/course.hpp"
#include "services/planner/fan.hpp"
#include "services/planner/kept_places.hpp"
#include "services/planner/movers.hpp"
#include "services/planner/planner.hpp"
#include "services/planner/prediction.hpp"
#include "services/planner/retreat.hpp"
#include "services/planner/search.hpp"
#include "services/planner/soft_places.hpp"
#include "services/planner/speed.hpp"

namespace gvom::planner {

class Planner::Impl {
 public:
  Impl(const PlannerConfig& config, int n_xy);

  void set_course(std::vector<Eigen::Vector2d> waypoints_m, std::size_t first);
  const Plan& cycle(const MapView* map, const State& state, const Senses& senses);
  const Plan& stand(Reason reason, const char* why);

 private:
  void begin_plan();
  void observe(const State& state, const Senses& senses);
  void forget_place();
  /// @return whether the planner may look at the map; if not, the plan says why.
  bool may_plan(const MapView* map, const Senses& senses);
  bool may_use(const MapView* map, const Senses& senses);
  void drive(const MapView& seen, const Senses& senses);
  void back(const Predicted& at, const Senses& senses);
  /// @return whether there is a way; if not, the plan says why.
  bool find_way(const MapView& map, const Predicted& at);
  /// By the last search.
  [[nodiscard]] double cost_from(const Predicted& at) const;
  SearchResult search(const MapView& map, const Predicted& at);
  void place_goal();
  void look_beyond_goal(const Predicted& at);
  void make_guide();
  void drive_on(const Trajectory& best, const Predicted& at, const Senses& senses);
  void explain(const SpeedLimits& limits);
  void stand_without_trajectory(const Senses& senses);
  /// Movers leave no way: it brakes along one that is free of what is there now.
  void brake_for_movers(const MapView& map, const Predicted& at);
  /// The heights of path and trajectory, for who looks at them.
  void raise_onto_ground();
  void watch_unseen(const Senses& senses);
  void watch_progress();
  [[nodiscard]] FanInput fan_input(const Predicted& at) const;
  [[nodiscard]] bool lead_is_free() const;
  /// Within the tolerance of the last waypoint.
  [[nodiscard]] bool at_end() const;
  [[nodiscard]] bool stands() const;
  /// Along what it drove last: that was free.
  void stop(Reason reason, Mode mode = Mode::stop);

  PlannerConfig config_;
  int n_xy_;
  Costmap costs_;
  Search search_;
  Search next_search_;  ///< From the waypoint on to the next one, when that is near.
  bool knows_next_ = false;
  PathOptimiser optimiser_;
  Fan fan_;
  SpeedProfile profile_;
  Prediction prediction_;
  KeptPlaces kept_;
  SoftPlaces soft_;
  ClosedPlaces closed_;
  Movers movers_;
  Retreat retreat_;
  Course course_;
  Progress progress_;

  Plan plan_;
  std::vector<Eigen::Vector2d> guide_;  ///< The searched path, and on towards the waypoint after it.
  MapView view_;                        ///< This cycle's map with what is closed and what movers may reach.
  Predicted now_;                       ///< The vehicle by its odometry.
  std::int64_t stamp_ns_ = 0;           ///< Of that.
  double room_now_m_ = 0;
  double base_z_m_ = 0;                          ///< Of base_link.
  double cost_to_go_ = 0;                        ///< When there last was a way.
  std::optional<std::int64_t> jump_ns_;          ///< Only a map from after it may be driven by.
  int must_stand_ = 0;                           ///< Cycles that it has to stand yet, after a jump.
  std::optional<std::int64_t> unseen_since_ns_;  ///< It stands before ground that does not show.
  std::vector<TrajectoryPoint> driven_;          ///< The last trajectory that was driven.
  bool arrived_ = false;
  bool gave_up_ = false;
};

}  // namespace gvom::planner
