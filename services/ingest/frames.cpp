#include "services/ingest/frames.hpp"

#include <pcap/dlt.h>

#include <algorithm>
#include <initializer_list>

#include "services/ingest/bytes.hpp"

namespace gvom::ingest {
namespace {

constexpr std::uint8_t kUdp = 17;
constexpr std::uint8_t kIpv6Fragment = 44;
constexpr int kRawIp = 101;  // LINKTYPE_RAW, where libpcap does not translate it to DLT_RAW

Bytes behind(Bytes bytes, std::size_t count) {
  return {bytes.data + count, bytes.size - count};
}

bool is_ip(std::uint16_t ethertype) {
  return ethertype == 0x0800 || ethertype == 0x86DD;
}

/// The IP packet behind a header that has its type at `type_at`; VLAN tags may stand between them.
Bytes strip_header(Bytes frame, std::size_t type_at, std::size_t header) {
  if (frame.size < header) return {};
  std::uint16_t type = load_be16(frame.data + type_at);
  Bytes rest = behind(frame, header);
  while (type == 0x8100 || type == 0x88A8 || type == 0x9100) {
    if (rest.size < 4) return {};
    type = load_be16(rest.data + 2);
    rest = behind(rest, 4);
  }
  return is_ip(type) ? rest : Bytes{};
}

/// Point-to-point protocol: FF 03, which may be left out, and the kind of what follows.
Bytes strip_ppp(Bytes frame) {
  if (frame.size >= 2 && load_be16(frame.data) == 0xFF03) frame = behind(frame, 2);
  if (frame.size < 2) return {};
  const std::uint16_t kind = load_be16(frame.data);
  return kind == 0x0021 || kind == 0x0057 ? behind(frame, 2) : Bytes{};
}

/// The IP packet in a frame; null data if there is none.
Bytes strip_link(int link_type, Bytes frame) {
  switch (link_type) {
    case DLT_EN10MB:
      return strip_header(frame, 12, 14);
    case DLT_LINUX_SLL:
      return strip_header(frame, 14, 16);
    case DLT_LINUX_SLL2:
      return strip_header(frame, 0, 20);
    case DLT_PPP:
    case DLT_PPP_SERIAL:
      return strip_ppp(frame);
    case DLT_NULL:
    case DLT_LOOP:
      return frame.size < 4 ? Bytes{} : behind(frame, 4);
    default:
      return frame;
  }
}

}  // namespace

FrameParser::FrameParser(int link_type, std::optional<std::uint16_t> port, SourceCounters& counters)
    : link_type_(link_type), port_(port), counters_(counters), fragments_(counters) {}

bool FrameParser::supports(int link_type) {
  const auto known = {DLT_EN10MB, DLT_LINUX_SLL, DLT_LINUX_SLL2, DLT_NULL, DLT_LOOP,      DLT_RAW,
                      DLT_IPV4,   DLT_IPV6,      kRawIp,         DLT_PPP,  DLT_PPP_SERIAL};
  return std::find(known.begin(), known.end(), link_type) != known.end();
}

bool FrameParser::parse(Bytes frame, std::int64_t capture_ns, Packet& out) {
  out = Packet{};
  out.capture_ns = capture_ns;
  const Bytes ip = strip_link(link_type_, frame);
  switch (parse_ip(ip, out)) {
    case Verdict::ok:
      return true;
    case Verdict::foreign:
      ++counters_.foreign_packets;
      return false;
    case Verdict::truncated:
      ++counters_.truncated_packets;
      return false;
    case Verdict::pending:
      return false;
  }
  return false;
}

FrameParser::Verdict FrameParser::parse_ip(Bytes ip, Packet& out) {
  if (ip.data == nullptr || ip.size == 0) return Verdict::foreign;
  const int version = ip.data[0] >> 4;
  if (version == 4) return parse_ipv4(ip, out);
  if (version == 6) return parse_ipv6(ip, out);
  return Verdict::foreign;
}

FrameParser::Verdict FrameParser::parse_ipv4(Bytes ip, Packet& out) {
  if (ip.size < 20) return Verdict::truncated;
  const std::size_t header = static_cast<std::size_t>(ip.data[0] & 0x0F) * 4;
  const std::size_t total = load_be16(ip.data + 2);
  if (ip.data[9] != kUdp || header < 20 || total < header) return Verdict::foreign;
  if (ip.size < total) return Verdict::truncated;
  const std::uint16_t flags = load_be16(ip.data + 6);
  Fragment part;
  part.source = ipv4_address(ip.data + 12);
  part.destination = ipv4_address(ip.data + 16);
  part.id = load_be16(ip.data + 4);
  part.offset = static_cast<std::size_t>(flags & 0x1FFF) * 8;
  part.more = (flags & 0x2000) != 0;
  part.data = ip.data + header;
  part.size = total - header;
  part.capture_ns = out.capture_ns;
  out.source = part.source;
  if (part.more || part.offset != 0) return reassemble(part, out);
  return parse_udp({part.data, part.size}, out);
}

FrameParser::Verdict FrameParser::parse_ipv6(Bytes ip, Packet& out) {
  constexpr std::size_t kHeader = 40;
  if (ip.size < kHeader) return Verdict::truncated;
  const std::size_t total = kHeader + load_be16(ip.data + 4);
  const std::uint8_t next = ip.data[6];
  if (next != kUdp && next != kIpv6Fragment) return Verdict::foreign;
  if (ip.size < total) return Verdict::truncated;
  out.source = ipv6_address(ip.data + 8);
  const Bytes payload{ip.data + kHeader, total - kHeader};
  if (next == kUdp) return parse_udp(payload, out);
  if (payload.size < 8 || payload.data[0] != kUdp) return Verdict::foreign;
  const std::uint16_t position = load_be16(payload.data + 2);
  Fragment part;
  part.source = out.source;
  part.destination = ipv6_address(ip.data + 24);
  part.id = load_be32(payload.data + 4);
  part.offset = position & 0xFFF8u;
  part.more = (position & 1) != 0;
  part.data = payload.data + 8;
  part.size = payload.size - 8;
  part.capture_ns = out.capture_ns;
  return reassemble(part, out);
}

FrameParser::Verdict FrameParser::reassemble(const Fragment& fragment, Packet& out) {
  const Bytes whole = fragments_.add(fragment);
  return whole.data == nullptr ? Verdict::pending : parse_udp(whole, out);
}

FrameParser::Verdict FrameParser::parse_udp(Bytes udp, Packet& out) const {
  constexpr std::size_t kHeader = 8;
  if (udp.size < kHeader) return Verdict::foreign;
  const std::size_t length = load_be16(udp.data + 4);
  if (length < kHeader || length > udp.size) return Verdict::foreign;
  out.port = load_be16(udp.data + 2);
  if (port_ && out.port != *port_) return Verdict::foreign;
  out.data = udp.data + kHeader;
  out.size = length - kHeader;
  return Verdict::ok;
}

}  // namespace gvom::ingest
