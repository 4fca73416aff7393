// A sweep as the sensor's own packets: Ouster's of profile RNG15_RFL8_NIR8, or a VLP-16's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "tools/sim/sweep_simulator.hpp"

namespace gvom::sim {

inline constexpr std::int64_t kSendDelay = 50'000;  ///< Nanoseconds from a packet's last column to the wire.

int columns_per_packet(const LidarModel& lidar);
/// Of a packet of the lidar as a record of a pcap file.
std::size_t record_bytes(const LidarModel& lidar);
inline int packets_of_sweep(const LidarModel& lidar) {
  return lidar.columns / columns_per_packet(lidar);
}

/// One packet of a sweep, counted from 0, as a pcap record of `record_bytes()` bytes; its payload begins
/// after `kPcapOverhead` of them.
void write_packet(const SweepSimulator& simulator, int sweep, int packet, std::uint8_t* record);
/// The stamp of a packet's last column.
std::int64_t end_of_packet_ns(const LidarModel& lidar, int sweep, int packet);

/// The pcap records of one sweep, `packets_of_sweep() * record_bytes()` bytes.
void write_sweep(const SweepSimulator& simulator, int sweep, std::uint8_t* records);

/// An Ouster's metadata as its firmware 2.x gives it.
std::string ouster_metadata(const LidarModel& lidar);

}  // namespace gvom::sim
