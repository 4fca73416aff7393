#include "services/ingest/packet_messages.hpp"

namespace gvom::ingest {
namespace {

/// What a Packet can say: from 1970 to 2106, else 0, not known.
std::int64_t capture_time_ns(std::int64_t time_ns) {
  const bool sane = time_ns >= 0 && time_ns < std::int64_t{0x100000000} * 1'000'000'000;
  return sane ? time_ns : 0;
}

Packet packet_of(const std::uint8_t* data, std::size_t size, std::int64_t capture_ns) {
  Packet packet;
  packet.data = data;
  packet.size = size;
  packet.capture_ns = capture_time_ns(capture_ns);
  return packet;
}

/// Packets of all profiles are whole words; Ouster's driver has published its buffer, a byte longer than what
/// it received.
std::size_t without_spare_byte(std::size_t size) {
  return size % 4 == 1 ? size - 1 : size;
}

}  // namespace

tl::expected<void, std::string> unpack(PacketMessages kind, ros::Bytes message, std::int64_t came_ns,
                                       std::vector<ros::VelodynePacketIn>& scan, std::vector<Packet>& out) {
  out.clear();
  if (kind == PacketMessages::ouster) {
    ros::Bytes bytes;
    const auto read = ros::read_ouster_packet(message, bytes);
    if (read) out.push_back(packet_of(bytes.data, without_spare_byte(bytes.size), came_ns));
    return read;
  }
  ros::HeaderIn header;
  const auto read = ros::read_velodyne_scan(message, header, scan);
  if (!read) return read;
  for (const ros::VelodynePacketIn& in : scan)
    out.push_back(packet_of(in.data, ros::kVelodynePacketBytes, in.stamp_ns));
  return {};
}

}  // namespace gvom::ingest
