// The pcap file that a lidar's packets travel in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/sim/lidar_model.hpp"

namespace gvom::sim {

inline constexpr std::size_t kPcapOverhead = 16 + 14 + 20 + 8;  // record header, Ethernet, IPv4, UDP

/// Which packet it is, and when it was on the wire.
struct PacketStamp {
  int number;  ///< Since the start of the recording.
  std::int64_t sent_ns;
};

/// Fills the first `kPcapOverhead` bytes of a record with one UDP datagram from the lidar; returns where its
/// payload begins.
std::uint8_t* begin_record(std::uint8_t* bytes, const LidarModel& lidar, const PacketStamp& stamp,
                           std::size_t payload_bytes);

/// The 24 bytes at the start of a pcap file.
std::vector<std::uint8_t> pcap_file_header();

}  // namespace gvom::sim
