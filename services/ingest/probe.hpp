// Whose packets a recording holds, before anything is made of them.
#pragma once

#include <string>

#include <tl/expected.hpp>

#include "services/ingest/decoder.hpp"
#include "services/ingest/packet.hpp"

namespace gvom::ingest {

/// What a recording holds in place of the packets that were asked for.
struct Strangers {
  bool found =
      false;  ///< No strangers: a packet of the sensor was found, and the decoder expects more like it.
  std::string of_another;  ///< Whose the packets are, if their bytes prove it, and the decoder's advice.
  std::string sizes;       ///< "12 of 1206 bytes, 3 of 48 bytes", or "none".
};

/// Reads up to the first packet that is of the decoder's sensor. Errors are those of `packets`.
tl::expected<Strangers, std::string> look_for_sensor(PacketSource& packets, Decoder& decoder);

/// The error for a recording that holds none. `where`: its name; `which`: the packets that were looked at.
std::string no_such_packets(const Strangers& strangers, const Decoder& decoder, const std::string& where,
                            const std::string& which);

}  // namespace gvom::ingest
