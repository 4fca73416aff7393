// Which waypoint is driven to, and whether the vehicle comes nearer to it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "services/common/planner_config.hpp"

namespace gvom::planner {

class Course {
 public:
  explicit Course(const PlannerConfig& config) : config_(config) {}

  /// @param waypoints_m places in odom
  /// @param first that it drives to
  void set(std::vector<Eigen::Vector2d> waypoints_m, std::size_t first = 0);

  /// Takes the next waypoint where this one is reached, or was passed by: the vehicle is beyond the plane
  /// through it that its approach crosses, within `kPassed` tolerances. The last one is never passed by.
  void update(const Eigen::Vector2d& vehicle_m);
  /// The place that stands for the present waypoint: a free one beside it, if it lies in an obstacle.
  void move_goal(const Eigen::Vector2d& goal_m) { goal_m_ = goal_m; }

  [[nodiscard]] bool empty() const { return waypoints_m_.empty(); }
  [[nodiscard]] std::size_t index() const { return index_; }
  [[nodiscard]] bool is_last() const { return index_ + 1 == waypoints_m_.size(); }
  [[nodiscard]] const Eigen::Vector2d& waypoint() const { return waypoints_m_[index_]; }
  [[nodiscard]] const Eigen::Vector2d* next() const {
    return is_last() ? nullptr : &waypoints_m_[index_ + 1];
  }
  [[nodiscard]] const Eigen::Vector2d& goal() const { return goal_m_; }
  [[nodiscard]] bool at_goal(const Eigen::Vector2d& vehicle_m) const {
    return (vehicle_m - goal_m_).norm() <= config_.goal_tolerance_m;
  }

  static constexpr double kPassed = 4;

 private:
  void begin(const Eigen::Vector2d& from_m);

  PlannerConfig config_;
  std::vector<Eigen::Vector2d> waypoints_m_;
  std::size_t index_ = 0;
  bool begun_ = false;
  Eigen::Vector2d goal_m_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d approach_ = Eigen::Vector2d::Zero();  ///< From where its leg began to the waypoint.
};

/// Whether there is progress: a cost or a distance that got less by `kLess`. A cost that jumps up, because
/// the map shows that a way is none, is the new one to be less than; the time goes on. In `kPatience` times
/// as long the least of all must have got less, or the vehicle drives to and fro for ever.
class Progress {
 public:
  explicit Progress(double give_up_s) : give_up_s_(give_up_s) {}

  void begin() { begun_ = false; }
  /// @return whether to give up
  bool update(std::int64_t stamp_ns, double cost_to_go, double distance_m);
  /// Time in which it could not drive does not count.
  void wait(std::int64_t stamp_ns);

  static constexpr double kLess = 1;
  static constexpr double kMostAtOnce_s = 1;  ///< More between two cycles is a clock's step, or a sleep.
  static constexpr double kPatience = 5;

 private:
  double give_up_s_;
  bool begun_ = false;
  std::int64_t last_ns_ = 0;
  double since_progress_s_ = 0, since_best_s_ = 0;
  double cost_ = 0, distance_m_ = 0;  ///< To be less than.
  double least_cost_ = 0, least_m_ = 0;
};

}  // namespace gvom::planner
