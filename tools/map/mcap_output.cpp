#include "tools/map/mcap_output.hpp"

namespace gvom::tools {

using bridge::TopicId;

tl::expected<McapOutput, std::string> McapOutput::create(const std::string& path,
                                                         const services::VehicleConfig& config) {
  auto file = MapFile::create(
      path, config,
      {TopicId::costmap, TopicId::grid_map, TopicId::layers, TopicId::points, TopicId::voxels, TopicId::tf});
  if (!file) return tl::unexpected(file.error());
  return McapOutput(std::move(*file));
}

tl::expected<void, std::string> McapOutput::write(const LayerArrays& layers, MapFuser& fuser) {
  const LayerMoment moment = fuser.moment();
  const auto written = file_.put_layers(layers, moment.grid, moment.T_odom_base, moment.stamp_ns);
  if (!written) return written;
  const auto shape = fuser.count_voxels();
  if (!shape) return tl::unexpected(shape.error().what);
  if (const auto made = fuser.write_voxels(voxels_.resize(*shape)); !made)
    return tl::unexpected(made.error().what);
  return file_.put_voxels(voxels_.view(moment.grid, moment.stamp_ns, moment.T_odom_base), moment.stamp_ns);
}

}  // namespace gvom::tools
