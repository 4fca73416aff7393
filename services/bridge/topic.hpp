// The topics of the bridge: what each is called and what it carries.
#pragma once

#include <array>
#include <cstddef>

namespace gvom::bridge {

/// In the order of kTopics.
enum class TopicId : std::size_t {
  costmap,
  grid_map,
  layers,
  points,
  voxels,
  tf,
  plan,
  trajectory,
  diagnostics,
  status,
};

struct Topic {
  TopicId id;
  const char* name;  ///< As ROS has it, with its leading slash.
  const char* type;  ///< "nav_msgs/msg/OccupancyGrid"; nullptr: the message is JSON.
  bool latched;      ///< Who comes late gets the newest at once.
};

inline constexpr std::array<Topic, 10> kTopics = {{
    {TopicId::costmap, "/gvom/costmap", "nav_msgs/msg/OccupancyGrid", true},
    {TopicId::grid_map, "/gvom/grid_map", "grid_map_msgs/msg/GridMap", false},
    {TopicId::layers, "/gvom/layers", "foxglove_msgs/msg/Grid", false},
    {TopicId::points, "/gvom/points", "sensor_msgs/msg/PointCloud2", false},
    {TopicId::voxels, "/gvom/voxels", "sensor_msgs/msg/PointCloud2", false},
    {TopicId::tf, "/tf", "tf2_msgs/msg/TFMessage", false},
    {TopicId::plan, "/gvom/plan", "nav_msgs/msg/Path", false},
    {TopicId::trajectory, "/gvom/trajectory", "nav_msgs/msg/Path", false},
    {TopicId::diagnostics, "/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", false},
    {TopicId::status, "/gvom/status", nullptr, false},
}};

constexpr const Topic& topic(TopicId id) {
  return kTopics[static_cast<std::size_t>(id)];
}

}  // namespace gvom::bridge
