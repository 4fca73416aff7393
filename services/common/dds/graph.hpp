// What `ros2 node list` shows of us: the topic ros_discovery_info, which says whose readers and writers are
// whose.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "services/common/dds/names.hpp"
#include "services/common/ros/blob.hpp"

namespace gvom::dds {

/// Whose messages: those two differ in the graph and in what a reader or writer says of its type.
enum class Distro { humble, jazzy };

/// Of a participant, reader or writer, as it is on the wire.
using Guid = std::array<std::uint8_t, 16>;

/// A participant with one node.
struct NodeEntities {
  Guid participant{};
  NodeName node;
  std::vector<Guid> readers;
  std::vector<Guid> writers;
};

/// rmw_dds_common/msg/ParticipantEntitiesInfo. A gid is the GUID, in Humble with eight zeros behind it.
ros::Blob graph_message(const NodeEntities& entities, Distro distro);

}  // namespace gvom::dds
