#include "services/bridge/message_maker.hpp"

#include <algorithm>

#include "ipc/span.hpp"
#include "services/common/ros/cloud_messages.hpp"
#include "services/common/ros/diagnostics_message.hpp"
#include "services/common/ros/grid_messages.hpp"

namespace gvom::bridge {

ros::Blob MessageMaker::of_layers(TopicId id, const ros::LayersView& layers) {
  const auto out = buffer(id);
  const std::string& frame = settings_.frames.odom;
  if (id == TopicId::costmap) ros::write_occupancy_grid(layers, frame, *out);
  if (id == TopicId::grid_map) ros::write_grid_map(layers, settings_.grid_map_layers, frame, *out);
  if (id == TopicId::layers) ros::write_foxglove_grid(layers, frame, *out);
  if (id == TopicId::points) ros::write_columns_cloud(layers, settings_.points_layers, frame, *out);
  return out;
}

ros::Blob MessageMaker::voxels(const BrickMapView& map) {
  const auto out = buffer(TopicId::voxels);
  ros::write_voxels_cloud(map, settings_.frames.odom, *out);
  return out;
}

ros::Blob MessageMaker::tf(std::int64_t stamp_ns, const PoseRecord& T_odom_base) {
  const auto out = buffer(TopicId::tf);
  ros::write_tf(stamp_ns, T_odom_base, settings_.frames, *out);
  return out;
}

ros::Blob MessageMaker::path(TopicId id, std::int64_t stamp_ns, const ipc::Plan& plan) {
  const bool whole = id == TopicId::plan;
  const std::size_t count = whole ? plan.path_count : plan.trajectory_count;
  const ipc::Span<const ipc::Plan::Point> points{whole ? plan.path : plan.trajectory,
                                                 std::min<std::size_t>(count, ipc::Plan::kMaxPoints)};
  const auto out = buffer(id);
  ros::write_path(stamp_ns, points, settings_.frames, *out);
  return out;
}

ros::Blob MessageMaker::diagnostics(std::int64_t stamp_ns, const std::vector<ipc::Health>& processes,
                                    std::int64_t now_mono_ns) {
  const auto out = buffer(TopicId::diagnostics);
  ros::write_diagnostics(stamp_ns, processes, now_mono_ns, *out);
  return out;
}

ros::Blob MessageMaker::status(const std::string& text) {
  const auto out = buffer(TopicId::status);
  out->assign(text.begin(), text.end());
  return out;
}

}  // namespace gvom::bridge
