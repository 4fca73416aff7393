// The packets in a driver's message: Ouster's PacketMsg, Velodyne's VelodyneScan.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/ros/incoming.hpp"
#include "services/ingest/packet.hpp"

namespace gvom::ingest {

enum class PacketMessages { ouster, velodyne };

/// Replaces what is in `out` by the message's packets, which point into it. Their capture time is their own
/// stamp in a scan, else `came_ns` (Unix time); 0 where that cannot be one. `scan` is for its own use.
/// Errors: the message is not what its kind says; `out` is then empty.
tl::expected<void, std::string> unpack(PacketMessages kind, ros::Bytes message, std::int64_t came_ns,
                                       std::vector<ros::VelodynePacketIn>& scan, std::vector<Packet>& out);

}  // namespace gvom::ingest
