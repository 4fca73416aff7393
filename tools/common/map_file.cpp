#include "tools/common/map_file.hpp"

#include "services/bridge/mcap_channels.hpp"

namespace gvom::tools {

using bridge::TopicId;
using Result = tl::expected<void, std::string>;

tl::expected<MapFile, std::string> MapFile::create(const std::string& path,
                                                   const services::VehicleConfig& config,
                                                   const std::vector<TopicId>& topics) {
  auto settings = bridge::message_settings(config);
  if (!settings) return tl::unexpected(settings.error().text());
  auto writer = mcap::Writer::create(path);
  if (!writer) return tl::unexpected(writer.error());
  MapFile file(std::move(*writer), std::move(*settings));
  for (const TopicId id : topics)
    file.channels_[id] = file.writer_.add_channel(bridge::mcap_channel(bridge::topic(id)));
  return file;
}

Result MapFile::put(TopicId id, std::int64_t stamp_ns, const ros::Blob& message) {
  return writer_.write(channels_.at(id), stamp_ns, *message);
}

Result MapFile::put_layers(const LayerArrays& layers, const Grid& grid, const Pose& T_odom_base,
                           std::int64_t stamp_ns) {
  ros::LayersView view;
  view.grid = grid;
  view.T_odom_base = record_of(T_odom_base);
  view.stamp_ns = stamp_ns;
  view.arrays = {layers.height,
                 layers.inferred_height,
                 layers.slope_x,
                 layers.slope_y,
                 layers.slope,
                 layers.roughness,
                 layers.obstacle_density,
                 layers.negative_delta,
                 layers.clearance,
                 layers.last_seen,
                 layers.flags,
                 layers.visibility,
                 layers.cost};
  Result written = put(TopicId::tf, stamp_ns, maker_.tf(stamp_ns, view.T_odom_base));
  for (const TopicId id : bridge::MessageMaker::kOfLayers)
    if (written && channels_.count(id) > 0) written = put(id, stamp_ns, maker_.of_layers(id, view));
  return written;
}

Result MapFile::put_voxels(const BrickMapView& map, std::int64_t stamp_ns) {
  return put(TopicId::voxels, stamp_ns, maker_.voxels(map));
}

Result MapFile::put_plan(const ipc::Plan& plan, std::int64_t stamp_ns) {
  const Result written = put(TopicId::plan, stamp_ns, maker_.path(TopicId::plan, stamp_ns, plan));
  if (!written) return written;
  return put(TopicId::trajectory, stamp_ns, maker_.path(TopicId::trajectory, stamp_ns, plan));
}

}  // namespace gvom::tools
