// An OS1-64-like lidar: where its beams point, when its columns fire, and the metadata that says so.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>

namespace gvom::sim {

inline constexpr int kBeams = 64;
inline constexpr int kColumns = 1024;
inline constexpr int kColumnsPerPacket = 16;
inline constexpr int kPackets = kColumns / kColumnsPerPacket;  // of a sweep
inline constexpr double kRangeUnit = 0.008;                    // metres, of profile RNG15
inline constexpr double kBeamOrigin = 0.015806;                // metres from the lidar's axis

struct LidarModel {
  std::string name;
  int number;   ///< Of this lidar in the vehicle: its serial number and noise depend on it.
  int rate_hz;  ///< Turns a second, 10 or 20.
  int udp_port;
  std::int64_t start_ns;  ///< Stamp of the first column.
  Eigen::Isometry3d T_base_sensor;
  std::array<double, kBeams> altitude_deg;
  std::array<double, kBeams> azimuth_deg;

  [[nodiscard]] std::int64_t stamp_ns(int sweep, int column) const;
  [[nodiscard]] std::uint64_t serial_number() const {
    return 990'000'000'001ULL + static_cast<std::uint64_t>(number);
  }
};

/// Beam angles with the small scatter of a factory calibration; each lidar has its own.
void calibrate_beams(LidarModel& lidar, std::uint64_t seed);

/// T_sensor_lidar: the lidar's frame turned by half a turn and raised, as in every OS1 (metres).
Eigen::Isometry3d lidar_to_sensor();

/// The sensor's metadata as its firmware 2.x gives it.
std::string metadata_json(const LidarModel& lidar);

}  // namespace gvom::sim
