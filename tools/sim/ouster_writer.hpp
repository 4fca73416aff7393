// Ouster packets of profile RNG15_RFL8_NIR8 and the pcap file that they travel in.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "tools/sim/lidar_model.hpp"

namespace gvom::sim {

inline constexpr std::size_t kPacketBytes = 32 + kColumnsPerPacket * (12 + 4 * kBeams) + 32;
inline constexpr std::size_t kFrameBytes = 14 + 20 + 8 + kPacketBytes;  // Ethernet, IPv4, UDP
inline constexpr std::size_t kRecordBytes = 16 + kFrameBytes;           // of the pcap file

/// One measurement; range 0: no return.
struct Pixel {
  std::uint16_t range_units;
  std::uint8_t reflectivity;
  std::uint8_t near_infrared;
};

/// A pcap record with one packet, filled column by column into `kRecordBytes` bytes that the caller keeps.
class PacketRecord {
 public:
  PacketRecord(std::uint8_t* bytes, const LidarModel& lidar, int sweep, int packet);

  /// `index` 0 .. 15 within the packet.
  void set_column(int index, std::int64_t stamp_ns, const Pixel (&pixels)[kBeams]);

 private:
  std::uint8_t* payload_;
  int first_column_;
};

/// The 24 bytes at the start of a pcap file.
std::vector<std::uint8_t> pcap_file_header();

}  // namespace gvom::sim
