// Names of ROS, and what they are called on the wire.
#pragma once

#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace gvom::dds {

/// A topic as ROS names it.
struct Topic {
  std::string name;       ///< "/gvom/costmap"
  std::string type;       ///< "nav_msgs/msg/OccupancyGrid"
  std::string type_hash;  ///< "RIHS01_" and 64 hexadecimal digits, or empty: not known.
};

/// "rt/gvom/costmap" for "/gvom/costmap". An error for what ROS refuses: not absolute, an empty part, other
/// characters than letters, digits and underscores, a part that begins with a digit, over 200 characters.
tl::expected<std::string, std::string> topic_on_wire(std::string_view name);

/// "nav_msgs::msg::dds_::OccupancyGrid_" for "nav_msgs/msg/OccupancyGrid". An error for anything else than
/// PACKAGE/msg/NAME.
tl::expected<std::string, std::string> type_on_wire(std::string_view type);

/// Where a node is listed: "/gvom/bridge" is the node "bridge" in the namespace "/gvom".
struct NodeName {
  std::string space;  ///< "/" or "/gvom".
  std::string name;
};

/// Takes a full name apart; the same rules as for topics.
tl::expected<NodeName, std::string> node_name(std::string_view full);

}  // namespace gvom::dds
