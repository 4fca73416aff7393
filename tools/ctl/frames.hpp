// What the process that listens on the bus hands to the one that shows it, over a socket pair of theirs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gvom::ctl {

enum class FrameKind : std::uint32_t {
  joined,    ///< Empty: it is on the bus.
  health,    ///< ipc::Health
  layers,    ///< ipc::Layers, the header alone
  odometry,  ///< ipc::MessageHeader
  pools,     ///< ipc::PoolUse, one for each pool
  note,      ///< Text: what the bus complains of.
  refusal,   ///< Text: why a message was not read.
};

struct Frame {
  FrameKind kind;
  std::int64_t mono_ns;  ///< When it was sent.
  std::vector<std::byte> payload;
};

/// False if nobody reads any more. A frame that finds the socket full is left out: newer ones come.
bool send_frame(int socket, FrameKind kind, const void* payload, std::size_t bytes);
bool send_frame(int socket, FrameKind kind, const std::string& text);

enum class Received { frame, nothing, end };

/// What is there now.
Received receive_frame(int socket, Frame& out);

}  // namespace gvom::ctl
