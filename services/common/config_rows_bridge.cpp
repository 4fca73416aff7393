// The rows of the bridge to ROS 2, Foxglove and files.
#include "services/common/config_table.hpp"

namespace gvom::services {

namespace {

using V = VehicleConfig;
constexpr bool kOptional = false;

}  // namespace

std::vector<VehicleRow> bridge_rows() {
  return {
      {{"bridge.rate_hz", "Hz", Rule::range, 0.1, 100, kOptional, "of what is made of layers, at most"},
       [](V& c) -> Field { return &c.bridge.rate_hz; }},
      {{"bridge.odom_frame", "", Rule::text, 0, 0, kOptional, "what others call the frame of the map"},
       [](V& c) -> Field { return &c.bridge.odom_frame; }},
      {{"bridge.base_frame", "", Rule::text, 0, 0, kOptional, "what they call the vehicle"},
       [](V& c) -> Field { return &c.bridge.base_frame; }},
      {{"bridge.grid_map_layers", "", Rule::text, 0, 0, kOptional,
        "of /gvom/grid_map, between commas: few, each is 4 bytes a column; where the first is unknown a "
        "column is hidden"},
       [](V& c) -> Field { return &c.bridge.grid_map_layers; }},
      {{"bridge.points_layers", "", Rule::text, 0, 0, kOptional,
        "that are fields of /gvom/points beside x, y and z, between commas"},
       [](V& c) -> Field { return &c.bridge.points_layers; }},

      {{"bridge.foxglove.address", "", Rule::text, 0, 0, kOptional,
        "of this machine, where Foxglove and browsers find the bridge; 0.0.0.0: all; empty: no server"},
       [](V& c) -> Field { return &c.bridge.foxglove.address; }},
      {{"bridge.foxglove.port", "", Rule::range, 0, 65535, kOptional,
        "0: any that is free, the log says which"},
       [](V& c) -> Field { return &c.bridge.foxglove.port; }},
      {{"bridge.foxglove.origins", "", Rule::text, 0, 0, kOptional,
        "of web pages that may connect, beside the bridge's own page, between commas"},
       [](V& c) -> Field { return &c.bridge.foxglove.origins; }},
      {{"bridge.foxglove.page", "", Rule::text, 0, 0, kOptional,
        "folder of the page that browsers get; empty: where it was installed"},
       [](V& c) -> Field { return &c.bridge.foxglove.page; }},

      {{"bridge.mcap.folder", "", Rule::text, 0, 0, kOptional,
        "where MCAP files are recorded; empty: none are"},
       [](V& c) -> Field { return &c.bridge.mcap.folder; }},
      {{"bridge.mcap.split_mb", "MB", Rule::range, 1, 1048576, kOptional, "a new file at this size"},
       [](V& c) -> Field { return &c.bridge.mcap.split_mb; }},
      {{"bridge.mcap.min_free_mb", "MB", Rule::range, 0, 1048576, kOptional,
        "the recording ends rather than leave less of the disk to the others"},
       [](V& c) -> Field { return &c.bridge.mcap.min_free_mb; }},
      {{"bridge.mcap.topics", "", Rule::text, 0, 0, kOptional, "that are recorded, between commas"},
       [](V& c) -> Field { return &c.bridge.mcap.topics; }},

      {{"bridge.ros2.distro", "", Rule::text, 0, 0, kOptional,
        "humble or jazzy, as the others on the network; empty: no ROS 2"},
       [](V& c) -> Field { return &c.bridge.ros2.distro; }},
      {{"bridge.ros2.domain", "", Rule::range, 0, 232, kOptional, "ROS_DOMAIN_ID"},
       [](V& c) -> Field { return &c.bridge.ros2.domain; }},
      {{"bridge.ros2.node", "", Rule::text, 0, 0, kOptional,
        "the node's full name; stands for /gvom in the topics' names"},
       [](V& c) -> Field { return &c.bridge.ros2.node; }},
      {{"bridge.ros2.topics", "", Rule::text, 0, 0, kOptional,
        "that are offered, between commas; /tf only if nobody else says where the vehicle is"},
       [](V& c) -> Field { return &c.bridge.ros2.topics; }},
      {{"bridge.ros2.interface", "", Rule::text, 0, 0, kOptional,
        "of the network, its name or address; empty: what Cyclone DDS finds beside the loopback, else that"},
       [](V& c) -> Field { return &c.bridge.ros2.interface; }},
      {{"bridge.ros2.peers", "", Rule::text, 0, 0, kOptional,
        "hosts that multicast does not reach, between commas"},
       [](V& c) -> Field { return &c.bridge.ros2.peers; }},
      {{"bridge.ros2.config_file", "", Rule::text, 0, 0, kOptional,
        "more of Cyclone DDS's XML, which comes after ours; empty: none"},
       [](V& c) -> Field { return &c.bridge.ros2.config_file; }},
  };
}

}  // namespace gvom::services
