// From captured link-layer frames to UDP payloads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "services/ingest/fragments.hpp"
#include "services/ingest/packet.hpp"

namespace gvom::ingest {

/// Takes Ethernet, Linux cooked v1 and v2 (all with VLAN tags), PPP, raw IP and loopback; IPv4 and IPv6; UDP.
/// Everything else is counted: `foreign_packets`, `truncated_packets`, `fragments`, `lost_fragments`.
class FrameParser {
 public:
  /// `link_type` is a DLT_ value of libpcap; with `port`, payloads to other ports are foreign.
  FrameParser(int link_type, std::optional<std::uint16_t> port, SourceCounters& counters);

  /// True if frames of this link type can be read.
  static bool supports(int link_type);

  /// The UDP payload that `frame` holds or completes. `out.data` is valid until the next call.
  bool parse(Bytes frame, std::int64_t capture_ns, Packet& out);

  /// Gives up fragmented datagrams that are not whole.
  void finish() { fragments_.clear(); }

  /// Datagrams given up of which the first fragment came, in a capture where no other fragment ever did.
  [[nodiscard]] std::uint64_t lonely_fragments() const { return fragments_.lonely(); }

 private:
  enum class Verdict { ok, foreign, truncated, pending };

  Verdict parse_ip(Bytes ip, Packet& out);
  Verdict parse_ipv4(Bytes ip, Packet& out);
  Verdict parse_ipv6(Bytes ip, Packet& out);
  Verdict reassemble(const Fragment& fragment, Packet& out);
  Verdict parse_udp(Bytes udp, Packet& out) const;

  int link_type_;
  std::optional<std::uint16_t> port_;
  SourceCounters& counters_;
  FragmentTable fragments_;
};

}  // namespace gvom::ingest
