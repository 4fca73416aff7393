#include "tools/sim/ouster_writer.hpp"

#include <cstring>

namespace gvom::sim {
namespace {

constexpr std::size_t kColumnBytes = 12 + 4 * kBeams;
constexpr std::size_t kPacketHeader = 32;
constexpr std::int64_t kSendDelay = 50'000;  // nanoseconds from the last column to the wire

/// Appends integers to bytes, either byte order.
class Appender {
 public:
  explicit Appender(std::uint8_t* at) : at_(at) {}

  Appender& little(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) *at_++ = static_cast<std::uint8_t>(value >> 8 * i);
    return *this;
  }

  Appender& big(std::uint64_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) *at_++ = static_cast<std::uint8_t>(value >> 8 * i);
    return *this;
  }

  [[nodiscard]] std::uint8_t* at() const { return at_; }

 private:
  std::uint8_t* at_;
};

/// The ones' complement sum of the header's 16-bit words, as IPv4 wants it.
std::uint16_t ip_checksum(const std::uint8_t* header) {
  std::uint32_t sum = 0;
  for (int i = 0; i < 20; i += 2) sum += static_cast<std::uint32_t>(header[i] << 8 | header[i + 1]);
  sum = (sum & 0xFFFF) + (sum >> 16);
  sum = (sum & 0xFFFF) + (sum >> 16);
  return static_cast<std::uint16_t>(~sum);
}

/// Ethernet, IPv4 and UDP headers; returns where the payload begins. The sensors are 192.0.2.10 and up,
/// an address range for documentation.
std::uint8_t* write_network_headers(std::uint8_t* at, const LidarModel& lidar, int packet_number) {
  Appender ethernet(at);
  ethernet.big(0x02'00'00'00'00'01, 6).big(0x02'00'00'00'01'00 + lidar.number, 6).big(0x0800, 2);
  std::uint8_t* ip = ethernet.at();
  constexpr std::uint64_t kDontFragment = 0x4000;
  Appender network(ip);
  network.big(0x4500, 2).big(20 + 8 + kPacketBytes, 2).big(packet_number & 0xFFFF, 2).big(kDontFragment, 2);
  network.big(64, 1).big(17, 1).big(0, 2);
  network.big(0xC0'00'02'0A + lidar.number, 4).big(0xC0'00'02'01, 4);
  Appender(ip + 10).big(ip_checksum(ip), 2);
  Appender udp(network.at());
  udp.big(lidar.udp_port, 2).big(lidar.udp_port, 2).big(8 + kPacketBytes, 2).big(0, 2);  // no checksum
  return udp.at();
}

}  // namespace

PacketRecord::PacketRecord(std::uint8_t* bytes, const LidarModel& lidar, int sweep, int packet)
    : first_column_(packet * kColumnsPerPacket) {
  std::memset(bytes, 0, kRecordBytes);
  const std::int64_t sent_ns = lidar.stamp_ns(sweep, first_column_ + kColumnsPerPacket - 1) + kSendDelay;
  Appender record(bytes);
  record.little(sent_ns / 1'000'000'000, 4).little(sent_ns % 1'000'000'000 / 1000, 4);
  record.little(kFrameBytes, 4).little(kFrameBytes, 4);
  payload_ = write_network_headers(record.at(), lidar, sweep * kPackets + packet);
  constexpr std::uint64_t kLidarPacket = 1;
  Appender header(payload_);
  header.little(kLidarPacket, 2).little((sweep + 1) & 0xFFFF, 2);
  header.little(7109750 + lidar.number, 3).little(lidar.serial_number(), 5);
}

void PacketRecord::set_column(int index, std::int64_t stamp_ns, const Pixel (&pixels)[kBeams]) {
  constexpr std::uint64_t kValid = 1;
  Appender column(payload_ + kPacketHeader + index * kColumnBytes);
  column.little(stamp_ns, 8).little(first_column_ + index, 2).little(kValid, 2);
  for (const Pixel& pixel : pixels)
    column.little(pixel.range_units, 2).little(pixel.reflectivity, 1).little(pixel.near_infrared, 1);
}

std::vector<std::uint8_t> pcap_file_header() {
  constexpr std::uint64_t kMicroseconds = 0xA1B2C3D4;
  constexpr std::uint64_t kEthernet = 1;
  std::vector<std::uint8_t> bytes(24);
  Appender(bytes.data())
      .little(kMicroseconds, 4)
      .little(2, 2)
      .little(4, 2)
      .little(0, 8)
      .little(65535, 4)
      .little(kEthernet, 4);
  return bytes;
}

}  // namespace gvom::sim
