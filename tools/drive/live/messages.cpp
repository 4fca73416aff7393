#include "tools/drive/live/messages.hpp"

#include <algorithm>
#include <iterator>

namespace gvom::driving {
namespace {

planner::Pose2 pose_of(const ipc::Plan::Point& point) {
  return {point.x_m, point.y_m, point.yaw_rad};
}

}  // namespace

planner::Plan plan_of(const ipc::Plan& message) {
  planner::Plan plan;
  plan.mode = static_cast<planner::Mode>(message.mode);
  plan.reason = static_cast<planner::Reason>(message.reason);
  plan.why = message.why;
  plan.waypoint = message.waypoint;
  plan.cost_to_go = message.cost_to_go;
  plan.seen_m = message.seen_m;
  for (std::uint32_t i = 0; i < message.path_count; ++i)
    plan.path.push_back({pose_of(message.path[i]), message.path[i].curvature_per_m, message.path[i].z_m});
  for (std::uint32_t i = 0; i < message.trajectory_count; ++i) {
    const ipc::Plan::Point& point = message.trajectory[i];
    plan.trajectory.push_back({pose_of(point), point.z_m, 0, 0, point.curvature_per_m, point.speed_mps});
  }
  return plan;
}

ipc::Course course_message(const std::vector<Eigen::Vector2d>& waypoints_m) {
  ipc::Course message{};
  for (const Eigen::Vector2d& place : waypoints_m) {
    if (message.count == ipc::Course::kMaxPlaces) break;
    message.places[message.count++] = {place.x(), place.y()};
  }
  return message;
}

void copy(const ipc::LayersSample& layers, const LayerArrays& out) {
  float* const floats[] = {out.height,    out.inferred_height, out.slope_x,          out.slope_y,
                           out.slope,     out.roughness,       out.obstacle_density, out.negative_delta,
                           out.clearance, out.last_seen};
  static_assert(std::size(floats) == kFloatLayers);
  for (int i = 0; i < kFloatLayers; ++i) {
    const auto values = layers.layer_f(static_cast<LayerId>(i));
    std::copy(values.begin(), values.end(), floats[i]);
  }
  std::uint8_t* const bytes[] = {out.flags, out.visibility, out.cost};
  for (int i = kFloatLayers; i < kLayers; ++i) {
    const auto values = layers.layer_u8(static_cast<LayerId>(i));
    std::copy(values.begin(), values.end(), bytes[i - kFloatLayers]);
  }
}

}  // namespace gvom::driving
