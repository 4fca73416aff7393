#include "tools/sim/packets.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "tools/sim/appender.hpp"
#include "tools/sim/pcap_record.hpp"

namespace gvom::sim {
namespace {

constexpr int kOusterColumns = 16;  // of a packet
constexpr std::size_t kOusterHeader = 32;
constexpr std::size_t kOusterFooter = 32;
constexpr int kPuckBlocks = 12;  // of a packet, two columns each
constexpr std::size_t kPuckBytes = 1206;

std::size_t ouster_column_bytes(const LidarModel& lidar) {
  return 12 + 4 * static_cast<std::size_t>(lidar.beams());
}

std::size_t payload_bytes(const LidarModel& lidar) {
  if (lidar.sensor == Sensor::vlp_16) return kPuckBytes;
  return kOusterHeader + kOusterColumns * ouster_column_bytes(lidar) + kOusterFooter;
}

/// The pixels of a packet's columns, one column after the other.
std::vector<Pixel> measure_packet(const SweepSimulator& simulator, int sweep, int first_column) {
  const int columns = columns_per_packet(simulator.lidar());
  const int beams = simulator.lidar().beams();
  std::vector<Pixel> pixels(static_cast<std::size_t>(columns) * beams);
  for (int i = 0; i < columns; ++i)
    simulator.measure_column(sweep, first_column + i, pixels.data() + static_cast<std::ptrdiff_t>(i) * beams);
  return pixels;
}

void write_ouster(const LidarModel& lidar, int sweep, int first_column, const Pixel* pixels,
                  std::uint8_t* payload) {
  constexpr std::uint64_t kLidarPacket = 1;
  constexpr std::uint64_t kValid = 1;
  Appender header(payload);
  header.little(kLidarPacket, 2).little((sweep + 1) & 0xFFFF, 2);
  header.little(7109750 + lidar.number, 3).little(lidar.serial_number(), 5);
  for (int i = 0; i < kOusterColumns; ++i) {
    Appender column(payload + kOusterHeader + static_cast<std::size_t>(i) * ouster_column_bytes(lidar));
    column.little(lidar.stamp_ns(sweep, first_column + i), 8).little(first_column + i, 2).little(kValid, 2);
    for (int beam = 0; beam < lidar.beams(); ++beam, ++pixels)
      column.little(pixels->range_units, 2).little(pixels->reflectivity, 1).little(pixels->near_infrared, 1);
  }
}

/// Single returns, the strongest; the stamp counts within the hour.
void write_puck(const LidarModel& lidar, int sweep, int first_column, const Pixel* pixels,
                std::uint8_t* payload) {
  constexpr std::uint64_t kFlag = 0xEEFF;
  constexpr std::int64_t kHourNs = 3'600'000'000'000;
  constexpr std::uint64_t kStrongest = 0x37;
  constexpr std::uint64_t kVlp16 = 0x22;
  Appender out(payload);
  for (int block = 0; block < kPuckBlocks; ++block) {
    const int column = first_column + 2 * block;
    out.little(kFlag, 2).little(static_cast<std::uint64_t>(column) * 36000 / lidar.columns, 2);
    for (int i = 0; i < 2 * lidar.beams(); ++i, ++pixels)
      out.little(pixels->range_units, 2).little(pixels->reflectivity, 1);
  }
  out.little(lidar.stamp_ns(sweep, first_column) % kHourNs / 1000, 4).little(kStrongest, 1).little(kVlp16, 1);
}

}  // namespace

int columns_per_packet(const LidarModel& lidar) {
  return lidar.sensor == Sensor::vlp_16 ? 2 * kPuckBlocks : kOusterColumns;
}

std::size_t record_bytes(const LidarModel& lidar) {
  return kPcapOverhead + payload_bytes(lidar);
}

std::int64_t end_of_packet_ns(const LidarModel& lidar, int sweep, int packet) {
  return lidar.stamp_ns(sweep, (packet + 1) * columns_per_packet(lidar) - 1);
}

void write_packet(const SweepSimulator& simulator, int sweep, int packet, std::uint8_t* record) {
  const LidarModel& lidar = simulator.lidar();
  const int first = packet * columns_per_packet(lidar);
  const std::vector<Pixel> pixels = measure_packet(simulator, sweep, first);
  const PacketStamp stamp{sweep * packets_of_sweep(lidar) + packet,
                          end_of_packet_ns(lidar, sweep, packet) + kSendDelay};
  std::memset(record, 0, record_bytes(lidar));
  std::uint8_t* payload = begin_record(record, lidar, stamp, payload_bytes(lidar));
  if (lidar.sensor == Sensor::vlp_16)
    write_puck(lidar, sweep, first, pixels.data(), payload);
  else
    write_ouster(lidar, sweep, first, pixels.data(), payload);
}

void write_sweep(const SweepSimulator& simulator, int sweep, std::uint8_t* records) {
  const LidarModel& lidar = simulator.lidar();
  for (int packet = 0; packet < packets_of_sweep(lidar); ++packet, records += record_bytes(lidar))
    write_packet(simulator, sweep, packet, records);
}

}  // namespace gvom::sim
