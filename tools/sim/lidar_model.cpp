#include "tools/sim/lidar_model.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/sim/noise.hpp"

namespace gvom::sim {
namespace {

constexpr double kTopAltitude = 16.6;                       // degrees; the lowest beam is its mirror
constexpr double kStagger[4] = {3.16, 1.05, -1.06, -3.17};  // degrees
constexpr double kRise = 36.18;                             // millimetres
constexpr double kScatter = 0.03;                           // degrees

double rounded(double value) {
  return std::round(value * 1000.0) / 1000.0;
}

std::vector<int> pixel_shifts(const LidarModel& lidar) {
  const double lowest = *std::min_element(lidar.azimuth_deg.begin(), lidar.azimuth_deg.end());
  std::vector<int> shifts;
  for (const double azimuth : lidar.azimuth_deg)
    shifts.push_back(static_cast<int>(std::lround((azimuth - lowest) * kColumns / 360.0)));
  return shifts;
}

}  // namespace

std::int64_t LidarModel::stamp_ns(int sweep, int column) const {
  const std::int64_t index = static_cast<std::int64_t>(sweep) * kColumns + column;
  return start_ns + index * 1'000'000'000 / (static_cast<std::int64_t>(rate_hz) * kColumns);
}

void calibrate_beams(LidarModel& lidar, std::uint64_t seed) {
  const std::uint64_t key = derive(derive(seed, 0xBEA), static_cast<std::uint64_t>(lidar.number));
  for (int beam = 0; beam < kBeams; ++beam) {
    const auto scatter = [&](int axis) {
      return kScatter * (2.0 * uniform(derive(key, static_cast<std::uint64_t>(2 * beam + axis))) - 1.0);
    };
    lidar.altitude_deg[beam] = rounded(kTopAltitude * (1.0 - 2.0 * beam / (kBeams - 1.0)) + scatter(0));
    lidar.azimuth_deg[beam] = rounded(kStagger[beam % 4] + scatter(1));
  }
}

Eigen::Isometry3d lidar_to_sensor() {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear().diagonal() = Eigen::Vector3d(-1.0, -1.0, 1.0);
  transform.translation().z() = 1e-3 * kRise;
  return transform;
}

std::string metadata_json(const LidarModel& lidar) {
  nlohmann::ordered_json json;
  json["base_pn"] = "";
  json["base_sn"] = "";
  json["beam_altitude_angles"] = lidar.altitude_deg;
  json["beam_azimuth_angles"] = lidar.azimuth_deg;
  json["build_date"] = "2022-04-14T21:11:47Z";
  json["build_rev"] = "v2.3.0";
  json["client_version"] = "gvom-sim";
  json["data_format"] = {{"column_window", {0, kColumns - 1}},
                         {"columns_per_frame", kColumns},
                         {"columns_per_packet", kColumnsPerPacket},
                         {"pixel_shift_by_row", pixel_shifts(lidar)},
                         {"pixels_per_column", kBeams},
                         {"udp_profile_imu", "LEGACY"},
                         {"udp_profile_lidar", "RNG15_RFL8_NIR8"}};
  json["hostname"] = "";
  json["image_rev"] = "simulated";
  json["imu_to_sensor_transform"] = {1, 0, 0, 6.253, 0, 1, 0, -11.775, 0, 0, 1, 7.645, 0, 0, 0, 1};
  json["initialization_id"] = 7109750 + lidar.number;
  json["json_calibration_version"] = 4;
  json["lidar_mode"] = std::to_string(kColumns) + "x" + std::to_string(lidar.rate_hz);
  json["lidar_origin_to_beam_origin_mm"] = 1e3 * kBeamOrigin;
  json["lidar_to_sensor_transform"] = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, kRise, 0, 0, 0, 1};
  json["prod_line"] = "OS-1-64";
  json["prod_pn"] = "840-103575-06";
  json["prod_sn"] = std::to_string(lidar.serial_number());
  json["proto_rev"] = "";
  json["status"] = "RUNNING";
  json["udp_port_imu"] = lidar.udp_port + 100;
  json["udp_port_lidar"] = lidar.udp_port;
  return json.dump(4) + "\n";
}

}  // namespace gvom::sim
