// The simulated lidars: where their beams point, when their columns fire, and how they report what they see.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::sim {

enum class Sensor : std::uint8_t { os1_64, os1_128, vlp_16 };

/// "os1-64", "os1-128" or "vlp-16"; the error lists them.
tl::expected<Sensor, std::string> find_sensor(const std::string& name);
const char* name_of(Sensor sensor);

/// A lidar of the vehicle. A column is what its beams measure at one angle; a sweep is a turn.
struct LidarModel {
  Sensor sensor;
  std::string name;
  int number;  ///< Of this lidar in the vehicle: its serial number and noise depend on it.
  int udp_port;
  std::int64_t start_ns;  ///< Stamp of the first column.
  Eigen::Isometry3d T_base_sensor;

  int columns;           ///< Of a turn.
  std::int64_t turn_ns;  ///< How long a turn takes.
  double range_unit_m;
  double beam_origin_m;              ///< From the lidar's axis; ranges count from the axis.
  Eigen::Isometry3d T_sensor_lidar;  ///< The frame that its beams turn in.
  std::vector<double> altitude_deg;  ///< Of each beam.
  std::vector<double> azimuth_deg;   ///< Of each beam, clockwise, beside its column's.

  [[nodiscard]] int beams() const { return static_cast<int>(altitude_deg.size()); }
  /// The stamp that the packets give the column.
  [[nodiscard]] std::int64_t stamp_ns(int sweep, int column) const;
  [[nodiscard]] int turns_per_s() const;
  [[nodiscard]] std::uint64_t serial_number() const {
    return 990'000'000'001ULL + static_cast<std::uint64_t>(number);
  }
};

/// What a lidar has of its own, beside its sensor's kind.
struct LidarPlace {
  std::string name;
  int number;
  int udp_port;
  std::int64_t start_ns;
  Eigen::Isometry3d T_base_sensor;
};

/// An OS1 turns `rate_hz` times a second, 10 or 20, and its beam angles have the small scatter of a factory
/// calibration, each lidar its own, drawn from `seed`. A VLP-16 turns 10.05 times, in columns of 0.2 degrees.
LidarModel make_lidar(Sensor sensor, const LidarPlace& place, int rate_hz, std::uint64_t seed);

}  // namespace gvom::sim
