#include "tools/drive/live/course_talk.hpp"

#include <utility>

namespace gvom::driving {

CourseTalk::CourseTalk(std::vector<Eigen::Vector2d> waypoints_m, std::uint64_t epoch, double max_age_s)
    : waypoints_m_(std::move(waypoints_m)), epoch_(epoch), max_age_s_(max_age_s) {}

bool CourseTalk::is_ready(const ipc::Plan& plan) const {
  return plan.header.epoch == epoch_ && plan.layers_age_s <= max_age_s_;
}

bool CourseTalk::is_of_course(const ipc::Plan& plan) const {
  return sent_ns_ != 0 && plan.header.epoch == epoch_ && plan.mono_begun_ns > sent_ns_ &&
         plan.waypoints == waypoints_m_.size() && plan.waypoint < waypoints_m_.size() &&
         waypoints_m_[plan.waypoint] == Eigen::Vector2d(plan.goal_x_m, plan.goal_y_m);
}

}  // namespace gvom::driving
