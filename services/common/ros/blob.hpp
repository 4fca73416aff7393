// A message on its way out.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace gvom::ros {

/// The bytes of one message, written once and shared by all that send it: CDR with its four-byte head
/// (00 01 00 00), or the text of a JSON message.
using Blob = std::shared_ptr<const std::vector<std::uint8_t>>;

}  // namespace gvom::ros
