#include "services/bridge/settings.hpp"

#include <algorithm>
#include <optional>

#include "services/bridge/address.hpp"

namespace gvom::bridge {
namespace {

using services::ConfigError;

tl::unexpected<ConfigError> unknown(const services::VehicleConfig& config, const std::string& key,
                                    const std::string& word, const std::string& known) {
  return tl::make_unexpected(
      ConfigError{config.path, key, "there is no '" + word + "'; expected some of: " + known});
}

tl::expected<std::vector<LayerId>, ConfigError> layers_of(const services::VehicleConfig& config,
                                                          const std::string& key, const std::string& text) {
  std::vector<LayerId> layers;
  for (const std::string& word : split_list(text)) {
    const auto layer = ros::layer_of(word);
    if (!layer) {
      std::string known;
      for (const std::string_view name : ros::kLayerNames)
        known += (known.empty() ? "" : ", ") + std::string(name);
      return unknown(config, key, word, known);
    }
    if (std::find(layers.begin(), layers.end(), *layer) == layers.end()) layers.push_back(*layer);
  }
  return layers;
}

tl::expected<void, ConfigError> check_frame(const services::VehicleConfig& config, const std::string& key,
                                            const std::string& frame) {
  if (!frame.empty() && frame.front() != '/' && frame.size() <= 255) return {};
  return tl::make_unexpected(
      ConfigError{config.path, key, "expected the name of a frame, without a slash before it"});
}

tl::expected<void, ConfigError> check_address(const services::VehicleConfig& config) {
  const std::string& address = config.bridge.foxglove.address;
  if (address.empty()) return {};
  const auto parsed = parse_address(address);
  if (parsed) return {};
  return tl::make_unexpected(ConfigError{config.path, "bridge.foxglove.address", parsed.error()});
}

tl::expected<std::set<TopicId>, ConfigError> topics_of(const services::VehicleConfig& config,
                                                       const std::string& key, const std::string& text) {
  std::set<TopicId> topics;
  for (const std::string& word : split_list(text)) {
    const auto found =
        std::find_if(kTopics.begin(), kTopics.end(), [&](const Topic& one) { return one.name == word; });
    if (found == kTopics.end()) {
      std::string known;
      for (const Topic& one : kTopics) known += (known.empty() ? "" : ", ") + std::string(one.name);
      return unknown(config, key, word, known);
    }
    topics.insert(found->id);
  }
  return topics;
}

}  // namespace

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::size_t first = text.find_first_not_of(" \t", begin);
    if (first < comma) {
      const std::size_t last = text.find_last_not_of(" \t", comma - 1);
      parts.push_back(text.substr(first, last - first + 1));
    }
    begin = comma + 1;
  }
  return parts;
}

tl::expected<MessageSettings, ConfigError> message_settings(const services::VehicleConfig& config) {
  const BridgeConfig& bridge = config.bridge;
  MessageSettings settings;
  settings.frames = {bridge.odom_frame, bridge.base_frame};
  for (const auto& [key, frame] :
       {std::pair{"bridge.odom_frame", bridge.odom_frame}, {"bridge.base_frame", bridge.base_frame}})
    if (auto checked = check_frame(config, key, frame); !checked) return tl::unexpected(checked.error());
  auto grid_map = layers_of(config, "bridge.grid_map_layers", bridge.grid_map_layers);
  if (!grid_map) return tl::unexpected(grid_map.error());
  auto points = layers_of(config, "bridge.points_layers", bridge.points_layers);
  if (!points) return tl::unexpected(points.error());
  settings.grid_map_layers = std::move(*grid_map);
  settings.points_layers = std::move(*points);
  return settings;
}

tl::expected<std::set<TopicId>, ConfigError> recorded_topics(const services::VehicleConfig& config) {
  return topics_of(config, "bridge.mcap.topics", config.bridge.mcap.topics);
}

tl::expected<std::set<TopicId>, ConfigError> ros2_topics(const services::VehicleConfig& config) {
  return topics_of(config, "bridge.ros2.topics", config.bridge.ros2.topics);
}

tl::expected<void, ConfigError> check_names(const services::VehicleConfig& config) {
  if (auto settings = message_settings(config); !settings) return tl::unexpected(settings.error());
  if (auto topics = recorded_topics(config); !topics) return tl::unexpected(topics.error());
  if (auto topics = ros2_topics(config); !topics) return tl::unexpected(topics.error());
  return check_address(config);
}

}  // namespace gvom::bridge
