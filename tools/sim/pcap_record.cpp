#include "tools/sim/pcap_record.hpp"

#include "tools/sim/appender.hpp"

namespace gvom::sim {
namespace {

constexpr std::size_t kIpHeader = 20;
constexpr std::size_t kUdpHeader = 8;
constexpr std::size_t kEthernetHeader = 14;

/// The ones' complement sum of the header's 16-bit words, as IPv4 wants it.
std::uint16_t ip_checksum(const std::uint8_t* header) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < kIpHeader; i += 2)
    sum += static_cast<std::uint32_t>(header[i] << 8 | header[i + 1]);
  sum = (sum & 0xFFFF) + (sum >> 16);
  sum = (sum & 0xFFFF) + (sum >> 16);
  return static_cast<std::uint16_t>(~sum);
}

/// Ethernet, IPv4 and UDP headers; returns where the payload begins. The sensors are 192.0.2.10 and up,
/// an address range for documentation.
std::uint8_t* write_network_headers(std::uint8_t* at, const LidarModel& lidar, int packet_number,
                                    std::size_t payload_bytes) {
  Appender ethernet(at);
  ethernet.big(0x02'00'00'00'00'01, 6).big(0x02'00'00'00'01'00 + lidar.number, 6).big(0x0800, 2);
  std::uint8_t* ip = ethernet.at();
  constexpr std::uint64_t kDontFragment = 0x4000;
  Appender network(ip);
  network.big(0x4500, 2).big(kIpHeader + kUdpHeader + payload_bytes, 2).big(packet_number & 0xFFFF, 2);
  network.big(kDontFragment, 2).big(64, 1).big(17, 1).big(0, 2);
  network.big(0xC0'00'02'0A + lidar.number, 4).big(0xC0'00'02'01, 4);
  Appender(ip + 10).big(ip_checksum(ip), 2);
  Appender udp(network.at());
  udp.big(lidar.udp_port, 2).big(lidar.udp_port, 2).big(kUdpHeader + payload_bytes, 2);
  udp.big(0, 2);  // no checksum
  return udp.at();
}

}  // namespace

std::uint8_t* begin_record(std::uint8_t* bytes, const LidarModel& lidar, const PacketStamp& stamp,
                           std::size_t payload_bytes) {
  const std::size_t frame = kEthernetHeader + kIpHeader + kUdpHeader + payload_bytes;
  Appender record(bytes);
  record.little(stamp.sent_ns / 1'000'000'000, 4).little(stamp.sent_ns % 1'000'000'000 / 1000, 4);
  record.little(frame, 4).little(frame, 4);
  return write_network_headers(record.at(), lidar, stamp.number, payload_bytes);
}

std::vector<std::uint8_t> pcap_file_header() {
  constexpr std::uint64_t kMicroseconds = 0xA1B2C3D4;
  constexpr std::uint64_t kEthernet = 1;
  std::vector<std::uint8_t> bytes(24);
  Appender header(bytes.data());
  header.little(kMicroseconds, 4)
      .little(2, 2)
      .little(4, 2)
      .little(0, 8)
      .little(65535, 4)
      .little(kEthernet, 4);
  return bytes;
}

}  // namespace gvom::sim
