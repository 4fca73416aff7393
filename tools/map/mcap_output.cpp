#include "tools/map/mcap_output.hpp"

#include "services/bridge/mcap_channels.hpp"

namespace gvom::tools {

using bridge::TopicId;

tl::expected<McapOutput, std::string> McapOutput::create(const std::string& path,
                                                         const services::VehicleConfig& config) {
  auto settings = bridge::message_settings(config);
  if (!settings) return tl::unexpected(settings.error().text());
  auto writer = mcap::Writer::create(path);
  if (!writer) return tl::unexpected(writer.error());
  return McapOutput(std::move(*writer), std::move(*settings));
}

McapOutput::McapOutput(mcap::Writer writer, bridge::MessageSettings settings)
    : writer_(std::move(writer)), maker_(std::move(settings)) {
  for (const TopicId id :
       {TopicId::costmap, TopicId::grid_map, TopicId::layers, TopicId::points, TopicId::voxels, TopicId::tf})
    channels_[id] = writer_.add_channel(bridge::mcap_channel(bridge::topic(id)));
}

tl::expected<void, std::string> McapOutput::put(TopicId id, std::int64_t stamp_ns, const ros::Blob& message) {
  return writer_.write(channels_.at(id), stamp_ns, *message);
}

tl::expected<void, std::string> McapOutput::write(const LayerArrays& layers, MapFuser& fuser) {
  const LayerMoment moment = fuser.moment();
  ros::LayersView view;
  view.grid = moment.grid;
  view.T_odom_base = record_of(moment.T_odom_base);
  view.stamp_ns = moment.stamp_ns;
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
  auto written = put(TopicId::tf, view.stamp_ns, maker_.tf(view.stamp_ns, view.T_odom_base));
  for (const TopicId id : bridge::MessageMaker::kOfLayers)
    if (written) written = put(id, view.stamp_ns, maker_.of_layers(id, view));
  return written ? put_voxels(fuser) : written;
}

tl::expected<void, std::string> McapOutput::put_voxels(MapFuser& fuser) {
  const auto shape = fuser.count_voxels();
  if (!shape) return tl::unexpected(shape.error().what);
  if (const auto made = fuser.write_voxels(voxels_.resize(*shape)); !made)
    return tl::unexpected(made.error().what);
  const LayerMoment moment = fuser.moment();
  const BrickMapView map = voxels_.view(moment.grid, moment.stamp_ns, moment.T_odom_base);
  return put(TopicId::voxels, moment.stamp_ns, maker_.voxels(map));
}

}  // namespace gvom::tools
