// What is on the bus becomes messages, each in one buffer that all sinks share.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/format/brick_map.hpp"
#include "ipc/messages.hpp"
#include "services/bridge/settings.hpp"
#include "services/bridge/topic.hpp"
#include "services/common/ros/blob_pool.hpp"

namespace gvom::bridge {

/// Use it in one thread.
class MessageMaker {
 public:
  explicit MessageMaker(MessageSettings settings) : settings_(std::move(settings)) {}

  /// The topics that are made of layers.
  static constexpr TopicId kOfLayers[] = {TopicId::costmap, TopicId::grid_map, TopicId::layers,
                                          TopicId::points};
  /// One of those.
  ros::Blob of_layers(TopicId id, const ros::LayersView& layers);

  /// The map's indices are to be right (validate_deep).
  ros::Blob voxels(const BrickMapView& map);
  ros::Blob tf(std::int64_t stamp_ns, const PoseRecord& T_odom_base);
  /// `id`: plan or trajectory. No more points than a plan has room for, whatever it says.
  ros::Blob path(TopicId id, std::int64_t stamp_ns, const ipc::Plan& plan);
  ros::Blob diagnostics(std::int64_t stamp_ns, const std::vector<ipc::Health>& processes,
                        std::int64_t now_mono_ns);
  /// JSON.
  ros::Blob status(const std::string& text);

 private:
  /// A buffer of this topic's own: their sizes differ by a thousand.
  ros::BlobPool::Buffer buffer(TopicId id) { return pools_[static_cast<std::size_t>(id)].take(); }

  MessageSettings settings_;
  std::array<ros::BlobPool, kTopics.size()> pools_;
};

}  // namespace gvom::bridge
