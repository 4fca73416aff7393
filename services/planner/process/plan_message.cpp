#include "services/planner/process/plan_message.hpp"

#include <algorithm>
#include <cstdio>

namespace gvom::planner {
namespace {

static_assert(static_cast<std::uint32_t>(Mode::gave_up) ==
              static_cast<std::uint32_t>(ipc::PlanMode::gave_up));

std::uint32_t fits(std::size_t points) {
  return static_cast<std::uint32_t>(std::min<std::size_t>(points, ipc::Plan::kMaxPoints));
}

ipc::Plan::Point point_of(const Pose2& pose, double z_m, double curvature_per_m, double speed_mps) {
  return {pose.x_m,
          pose.y_m,
          static_cast<float>(z_m),
          static_cast<float>(pose.yaw_rad),
          static_cast<float>(curvature_per_m),
          static_cast<float>(speed_mps)};
}

}  // namespace

void fill(const Plan& plan, ipc::Plan& message) {
  message.mode = static_cast<std::uint32_t>(plan.mode);
  message.reason = static_cast<std::uint32_t>(plan.reason);
  std::snprintf(message.why, sizeof message.why, "%s", plan.why.c_str());
  message.waypoint = static_cast<std::uint32_t>(plan.waypoint);
  message.cost_to_go = plan.cost_to_go;
  message.seen_m = plan.seen_m;
  message.path_count = fits(plan.path.size());
  for (std::uint32_t i = 0; i < message.path_count; ++i)
    message.path[i] = point_of(plan.path[i].pose, plan.path[i].z_m, plan.path[i].curvature_per_m, 0);
  message.trajectory_count = fits(plan.trajectory.size());
  for (std::uint32_t i = 0; i < message.trajectory_count; ++i) {
    const TrajectoryPoint& point = plan.trajectory[i];
    message.trajectory[i] = point_of(point.pose, point.z_m, point.curvature_per_m, point.speed_mps);
  }
}

}  // namespace gvom::planner
