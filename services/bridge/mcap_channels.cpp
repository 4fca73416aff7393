#include "services/bridge/mcap_channels.hpp"

#include "services/common/ros/schemas.hpp"

namespace gvom::bridge {
namespace {

/// Numbers as rosbag2 has them: keep last 1, reliable; transient local is 1, volatile 2; no deadlines.
std::string offered_qos(const Topic& topic) {
  const std::string never = "\n    sec: 2147483647\n    nsec: 4294967295\n";
  return "- history: 1\n  depth: 1\n  reliability: 1\n  durability: " +
         std::string(topic.latched ? "1" : "2") + "\n  deadline:" + never + "  lifespan:" + never +
         "  liveliness: 1\n  liveliness_lease_duration:" + never +
         "  avoid_ros_namespace_conventions: false\n";
}

}  // namespace

mcap::OutChannel mcap_channel(const Topic& topic) {
  if (topic.type == nullptr) return {topic.name, "json", "", "", ""};
  return {topic.name, "cdr", topic.type, ros::schema_of(topic.type).value_or(""), offered_qos(topic)};
}

}  // namespace gvom::bridge
