// Velodyne packets built by hand: one laser at a known place, turns, times within the hour.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "tests/ingest/frames_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace gvom::test {

using ingest::SourceCounters;

inline constexpr double kRadians = 3.14159265358979323846 / 180;

struct Shot {
  int azimuth = 0;  // 1/100 degree
  int laser = 0;    // 0 .. 31: the only measurement of the block that is not 0
  int range = 0;
};

inline ByteVector velodyne_packet(const std::vector<Shot>& blocks, std::uint32_t time_us, int mode = 0x37,
                                  int product = 0x22) {
  ByteVector out;
  for (const Shot& shot : blocks) {
    append(out, {0xFF, 0xEE});
    put_le(out, static_cast<std::uint16_t>(shot.azimuth));
    for (int laser = 0; laser < 32; ++laser) {
      put_le(out, static_cast<std::uint16_t>(laser == shot.laser ? shot.range : 0));
      out.push_back(99);
    }
  }
  put_le(out, time_us);
  append(out, {static_cast<std::uint8_t>(mode), static_cast<std::uint8_t>(product)});
  return out;
}

/// A VLP-16 at 10 turns a second, 39.8 hundredths of a degree a block; every laser 0 returns at 2 m. Block
/// `n` counts from azimuth 0.
inline ByteVector turning_packet(int first_block, std::uint32_t start_us = 0, int mode = 0x37,
                                 int product = 0x22) {
  const int step = mode == 0x39 ? 2 : 1;
  std::vector<Shot> blocks;
  for (int i = 0; i < 12; ++i) blocks.push_back({(first_block + i / step) * 398 / 10 % 36000, 0, 1000});
  return velodyne_packet(blocks, start_us + static_cast<std::uint32_t>(std::lround(first_block * 110.592)),
                         mode, product);
}

struct Played {
  std::vector<Sweep> sweeps;
  SourceCounters counters;
  std::vector<std::string> warnings;
};

inline Played play(const std::vector<ByteVector>& packets, const std::string& model = "VLP-16",
                   double min_fraction = 0.5, std::int64_t capture_ns = 0) {
  TemporaryFolder folder;
  PcapWriter pcap(folder.path() + "/velodyne.pcap");
  for (const ByteVector& packet : packets) pcap.add(frame(packet, {1, 2368, 1}), capture_ns);
  auto source = open("velodyne:" + pcap.write() + "?model=" + model, {min_fraction, 200000});
  Played out;
  out.sweeps = all_sweeps(*source);
  out.counters = source->counters();
  out.warnings = source->warnings();
  return out;
}

/// The return of a packet whose blocks turn by `gap` and of which block 0 has one measurement.
inline Return one_return(const std::string& model, const Shot& shot, int gap, int product) {
  std::vector<Shot> blocks{shot};
  for (int i = 1; i < 12; ++i) blocks.push_back({shot.azimuth + i * gap, 0, 0});
  const auto played = play({velodyne_packet(blocks, 0, 0x37, product)}, model, 0.0);
  CHECK(played.warnings.empty());
  REQUIRE(played.sweeps.size() == 1);
  REQUIRE(played.sweeps[0].returns.size() == 1);
  return played.sweeps[0].returns[0];
}

inline void check_polar(const Return& r, double range_m, double azimuth_deg, double vertical_deg) {
  CHECK(r.x_m ==
        Approx(range_m * std::cos(vertical_deg * kRadians) * std::cos(azimuth_deg * kRadians)).margin(1e-9));
  CHECK(r.y_m ==
        Approx(-range_m * std::cos(vertical_deg * kRadians) * std::sin(azimuth_deg * kRadians)).margin(1e-9));
  CHECK(r.z_m == Approx(range_m * std::sin(vertical_deg * kRadians)).margin(1e-9));
}

inline std::vector<ByteVector> turn(int turns, std::uint32_t start_us = 0, int mode = 0x37,
                                    int product = 0x22) {
  std::vector<ByteVector> packets;
  const int step = mode == 0x39 ? 6 : 12;
  for (int block = 0; block < 905 * turns; block += step)
    packets.push_back(turning_packet(block, start_us, mode, product));
  return packets;
}

}  // namespace gvom::test
