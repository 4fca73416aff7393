// gvom-map's maps as one MCAP file: the messages that gvom-bridge sends.
#pragma once

#include <map>
#include <string>

#include <tl/expected.hpp>

#include "services/bridge/message_maker.hpp"
#include "services/common/mcap/mcap_writer.hpp"
#include "tools/map/offline.hpp"

namespace gvom::tools {

class McapOutput {
 public:
  /// Errors name the file, or the key that is wrong.
  static tl::expected<McapOutput, std::string> create(const std::string& path,
                                                      const services::VehicleConfig& config);

  /// Layers, which are of now, voxels and the vehicle's pose.
  tl::expected<void, std::string> write(const LayerArrays& layers, MapFuser& fuser);

  tl::expected<void, std::string> close() { return writer_.close(); }
  [[nodiscard]] std::uint64_t messages() const { return writer_.messages(); }

 private:
  McapOutput(mcap::Writer writer, bridge::MessageSettings settings);
  tl::expected<void, std::string> put(bridge::TopicId id, std::int64_t stamp_ns, const ros::Blob& message);
  tl::expected<void, std::string> put_voxels(MapFuser& fuser);

  mcap::Writer writer_;
  bridge::MessageMaker maker_;
  std::map<bridge::TopicId, std::uint16_t> channels_;
  BrickMapStorage voxels_;
};

}  // namespace gvom::tools
