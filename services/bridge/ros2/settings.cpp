#include "services/bridge/ros2/settings.hpp"

#include <utility>

#include "services/bridge/settings.hpp"

namespace gvom::bridge {
namespace {

using services::ConfigError;

tl::unexpected<ConfigError> wrong(const services::VehicleConfig& config, const std::string& key,
                                  const std::string& why) {
  return tl::make_unexpected(ConfigError{config.path, "bridge.ros2" + key, why});
}

}  // namespace

tl::expected<Ros2Settings, ConfigError> ros2_settings(const services::VehicleConfig& config) {
  const Ros2Config& keys = config.bridge.ros2;
  if (keys.distro != "humble" && keys.distro != "jazzy")
    return wrong(config, ".distro", "expected humble or jazzy, or nothing, not '" + keys.distro + "'");
  Ros2Settings settings;
  settings.participant.distro = keys.distro == "humble" ? dds::Distro::humble : dds::Distro::jazzy;
  settings.participant.node = keys.node;
  if (const auto node = dds::node_name(keys.node); !node) return wrong(config, ".node", node.error());
  settings.participant.domain = {keys.domain, keys.interface, split_list(keys.peers), keys.config_file};
  if (const auto xml = dds::domain_xml(settings.participant.domain); !xml)
    return wrong(config, "", xml.error());
  auto topics = ros2_topics(config);
  if (!topics) return tl::unexpected(topics.error());
  for (const TopicId id : *topics)
    if (topic(id).type == nullptr)
      return wrong(config, ".topics", std::string(topic(id).name) + " is no message of ROS's");
  settings.topics = std::move(*topics);
  return settings;
}

std::string topic_of_node(const std::string& topic, const std::string& node) {
  const std::string own = "/gvom/";
  return topic.compare(0, own.size(), own) == 0 ? node + topic.substr(own.size() - 1) : topic;
}

}  // namespace gvom::bridge
