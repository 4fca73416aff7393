// What a planner's plans say of the course: may it be sent, and is a plan of it?
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ipc/messages.hpp"

namespace gvom::driving {

/// A planner that runs already may plan by an earlier course, odometry and map: its plans are none of this.
class CourseTalk {
 public:
  /// @param epoch of this vehicle's odometry
  /// @param max_age_s of layers that the planner plans by
  CourseTalk(std::vector<Eigen::Vector2d> waypoints_m, std::uint64_t epoch, double max_age_s);

  /// It knows where this vehicle is, and has a map.
  [[nodiscard]] bool is_ready(const ipc::Plan& plan) const;
  /// The course is on the bus. @param mono_ns now (CLOCK_MONOTONIC)
  void sent(std::int64_t mono_ns) { sent_ns_ = mono_ns; }
  /// It was made after the course was sent, by this course and of this vehicle.
  [[nodiscard]] bool is_of_course(const ipc::Plan& plan) const;

 private:
  std::vector<Eigen::Vector2d> waypoints_m_;
  std::uint64_t epoch_;
  double max_age_s_;
  std::int64_t sent_ns_ = 0;
};

}  // namespace gvom::driving
