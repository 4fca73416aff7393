// Maps and plans as one MCAP file: the messages that gvom-bridge sends.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/format/layers.hpp"
#include "core/pose.hpp"
#include "services/bridge/message_maker.hpp"
#include "services/common/mcap/mcap_writer.hpp"

namespace gvom::tools {

/// Errors name the file and the reason.
class MapFile {
 public:
  /// A file of these topics. Errors too: a key `bridge.*` that is wrong.
  static tl::expected<MapFile, std::string> create(const std::string& path,
                                                   const services::VehicleConfig& config,
                                                   const std::vector<bridge::TopicId>& topics);

  /// The vehicle's pose, and those of the file's topics that are made of layers.
  tl::expected<void, std::string> put_layers(const LayerArrays& layers, const Grid& grid,
                                             const Pose& T_odom_base, std::int64_t stamp_ns);
  tl::expected<void, std::string> put_voxels(const BrickMapView& map, std::int64_t stamp_ns);
  /// Path and trajectory.
  tl::expected<void, std::string> put_plan(const ipc::Plan& plan, std::int64_t stamp_ns);

  /// Writes what waits, and the summary.
  tl::expected<void, std::string> close() { return writer_.close(); }

 private:
  MapFile(mcap::Writer writer, bridge::MessageSettings settings)
      : writer_(std::move(writer)), maker_(std::move(settings)) {}
  tl::expected<void, std::string> put(bridge::TopicId id, std::int64_t stamp_ns, const ros::Blob& message);

  mcap::Writer writer_;
  bridge::MessageMaker maker_;
  std::map<bridge::TopicId, std::uint16_t> channels_;
};

}  // namespace gvom::tools
