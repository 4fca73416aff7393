// What can be configured about the bridge. Default, unit, range and meaning stand on each field; the YAML
// keys carry the fields' names.
#pragma once

#include <string>

namespace gvom::bridge {

/// `bridge.foxglove.*`: the server for Foxglove, Lichtblick and the page.
struct FoxgloveConfig {
  std::string address = "127.0.0.1";  ///< Of this machine, to listen at; 0.0.0.0: all. Empty: no server.
  int port = 8765;                    ///< 0 .. 65535; 0: any that is free.
  /// Origins of web pages that may connect, beside the bridge's own; between commas.
  std::string origins = "https://app.foxglove.dev,https://studio.foxglove.dev,file://";
  std::string page;  ///< Folder of the page; empty: where it was installed.
};

/// `bridge.mcap.*`: the recorder.
struct McapConfig {
  std::string folder;   ///< Where files go; empty: nothing is recorded.
  int split_mb = 1024;  ///< A new file at this size, 1 .. 1048576.
  /// The recording ends rather than leave less than this on the disk to the others, 0 .. 1048576.
  int min_free_mb = 1024;
  /// Which are recorded, between commas. /gvom/status is not: it is JSON, and ros2 bag opens no file with it.
  std::string topics = "/gvom/costmap,/gvom/layers,/gvom/voxels,/tf,/gvom/plan,/gvom/trajectory,/diagnostics";
};

/// `bridge.ros2.*`: a node of ROS 2.
struct Ros2Config {
  std::string distro;          ///< "humble" or "jazzy", as the others on the network; empty: no ROS 2.
  int domain = 0;              ///< ROS_DOMAIN_ID, 0 .. 232.
  std::string node = "/gvom";  ///< Its full name; stands for /gvom in the topics' names.
  std::string topics =
      "/gvom/costmap,/gvom/grid_map,/gvom/points,/gvom/voxels,/gvom/plan,/gvom/trajectory,"
      "/diagnostics";  ///< Which are offered, between commas.
  std::string
      interface;      ///< A name or an address; empty: what Cyclone DDS finds beside the loopback, else that.
  std::string peers;  ///< That multicast does not reach, between commas.
  std::string config_file;  ///< More of Cyclone DDS's XML; empty: none.
};

/// `bridge.*`.
struct BridgeConfig {
  double rate_hz = 10.0;                        ///< Of what is made of layers, at most, 0.1 .. 100.
  std::string odom_frame = "odom";              ///< What the others call the frame of the map.
  std::string base_frame = "base_link";         ///< And the vehicle.
  std::string grid_map_layers = "height,cost";  ///< Between commas: few, each is 4 bytes a column.
  std::string points_layers = "slope,roughness,obstacle_density,cost";  ///< Fields of the columns' cloud.
  FoxgloveConfig foxglove;
  McapConfig mcap;
  Ros2Config ros2;
};

}  // namespace gvom::bridge
