// What the bridge's keys mean: names looked up, so that a misspelt one is told before anything runs.
#pragma once

#include <set>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/bridge/topic.hpp"
#include "services/common/config_file.hpp"
#include "services/common/ros/layers_view.hpp"
#include "services/common/ros/pose_messages.hpp"

namespace gvom::bridge {

/// How messages are made.
struct MessageSettings {
  ros::Frames frames;
  std::vector<LayerId> grid_map_layers;
  std::vector<LayerId> points_layers;
};

/// The error names the key, the word that is unknown, and those that are known.
tl::expected<MessageSettings, services::ConfigError> message_settings(const services::VehicleConfig& config);

/// `bridge.mcap.topics`; errors likewise.
tl::expected<std::set<TopicId>, services::ConfigError> recorded_topics(const services::VehicleConfig& config);

/// `bridge.ros2.topics`; errors likewise.
tl::expected<std::set<TopicId>, services::ConfigError> ros2_topics(const services::VehicleConfig& config);

/// The error of the first of these that has one, or of `bridge.foxglove.address`: what a vehicle's file says
/// of the bridge, wherever it runs.
tl::expected<void, services::ConfigError> check_names(const services::VehicleConfig& config);

/// The parts between commas, without blanks around them; empty ones are left out.
std::vector<std::string> split_list(const std::string& text);

}  // namespace gvom::bridge
