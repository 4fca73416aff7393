// What the keys bridge.ros2.* mean.
#pragma once

#include <set>
#include <string>

#include <tl/expected.hpp>

#include "services/bridge/topic.hpp"
#include "services/common/config_file.hpp"
#include "services/common/dds/participant.hpp"

namespace gvom::bridge {

struct Ros2Settings {
  dds::ParticipantOptions participant;
  std::set<TopicId> topics;  ///< That are offered; all have a type of ROS's.
};

/// Errors name the key: a distro that is not known, a node or topic that ROS or the bridge does not know, a
/// domain, interface, peer or file that dds::domain_xml refuses.
tl::expected<Ros2Settings, services::ConfigError> ros2_settings(const services::VehicleConfig& config);

/// "/front/costmap" for "/gvom/costmap" of the node "/front"; names elsewhere stay as they are.
std::string topic_of_node(const std::string& topic, const std::string& node);

}  // namespace gvom::bridge
