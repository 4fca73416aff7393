// The packets of a simulated recording, in memory, as they are due in each round.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::endurance {

/// A packet of a lidar in the profiles with the frame in bytes 2 and 3, which is patched in each round.
struct TimedPacket {
  std::int64_t due_ns;  ///< After the round's begin.
  std::uint32_t lidar;
  std::uint16_t frame;  ///< Of the round, from 0.
  std::vector<std::uint8_t> bytes;
};

struct Recording {
  std::vector<TimedPacket> packets;   ///< Of all lidars, as they are due.
  std::vector<std::uint64_t> sweeps;  ///< Of each lidar, in a round.
};

/// `FOLDER/NAME.pcap` of each lidar and `FOLDER/odometry.tum`. The frames that end less than kQuiet_ns before
/// the odometry does are left out, so that every sweep is mapped before the next round begins. Errors name
/// the file.
tl::expected<Recording, std::string> read_recording(const std::string& folder,
                                                    const std::vector<std::string>& lidars);

/// Shorter than the silence at which Health complains.
inline constexpr std::int64_t kQuiet_ns = 300'000'000;

}  // namespace gvom::endurance
