// The definitions of the ROS 2 types that the bridge sends and the odometry reads.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace gvom::ros {

/// The text of encoding `ros2msg`: the type's definition, then those of all types in it, each after a line of
/// 80 `=` and `MSG: package/Name`. `type` as "nav_msgs/msg/OccupancyGrid"; nothing if it is not one of those
/// that are sent or read.
std::optional<std::string> schema_of(std::string_view type);

/// `RIHS01_` and 64 hex digits: what ROS 2 from Iron on calls the type's definition. Nothing as schema_of.
std::optional<std::string> type_hash_of(std::string_view type);

}  // namespace gvom::ros
