// The whole recording: what each lidar measures while the vehicle drives, as files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/sim/lidar_model.hpp"
#include "tools/sim/ouster_writer.hpp"
#include "tools/sim/trajectory.hpp"
#include "tools/sim/world.hpp"

namespace gvom::sim {

/// Stamp of the start of the drive.
inline constexpr std::int64_t kStartNs = 1000'000'000'000;

struct RecordingOptions {
  double seconds = 12.0;
  double speed_mps = 5.0;
  std::uint64_t seed = 1;
  OdometryNoise odometry_noise;
  double range_noise_m = 0.02;  ///< Standard deviation.
  int rate_hz = 10;
  int threads = 1;  ///< Does not change a byte.

  [[nodiscard]] int sweeps() const { return static_cast<int>(seconds * rate_hz + 0.5); }
  [[nodiscard]] double length_m() const { return seconds * speed_mps; }
};

/// What is simulated, for as long as it is.
struct Scene {
  const World& world;
  const Trajectory& trajectory;
  const RecordingOptions& options;
};

/// The pcap records of one sweep, `kPackets * kRecordBytes` bytes. Each column is cast from where the lidar
/// is at the column's own stamp.
void simulate_sweep(const Scene& scene, const LidarModel& lidar, int sweep, std::uint8_t* records);

/// Writes NAME.pcap and NAME.json for each lidar and odometry.tum. Errors name the file.
tl::expected<void, std::string> write_recording(const Scene& scene, const std::vector<LidarModel>& lidars,
                                                const std::string& directory);

}  // namespace gvom::sim
