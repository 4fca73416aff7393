// The whole recording: what each lidar measures while the vehicle drives, as files.
#pragma once

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/sim/sweep_simulator.hpp"
#include "tools/sim/trajectory.hpp"

namespace gvom::sim {

struct RecordingOptions {
  double seconds = 12.0;
  double speed_mps = 5.0;
  OdometryNoise odometry_noise;
  SweepOptions sweep;
  Sensor sensor = Sensor::os1_64;  ///< All lidars are of this kind.
  int rate_hz = 10;
  int threads = 1;  ///< Does not change a byte.

  [[nodiscard]] double length_m() const { return seconds * speed_mps; }
};

/// What is simulated, for as long as it is.
struct Scene {
  const World& world;
  const Trajectory& trajectory;
  const RecordingOptions& options;
  std::vector<LidarModel> lidars;
  int sweeps;  ///< Of each lidar.
};

/// Writes NAME.pcap and, of an Ouster, NAME.json for each lidar, and odometry.tum. Errors name the file.
tl::expected<void, std::string> write_recording(const Scene& scene, const std::string& directory);

}  // namespace gvom::sim
