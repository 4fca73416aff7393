#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/sim/packets.hpp"

namespace gvom::sim {
namespace {

std::vector<int> pixel_shifts(const LidarModel& lidar) {
  const double lowest = *std::min_element(lidar.azimuth_deg.begin(), lidar.azimuth_deg.end());
  std::vector<int> shifts;
  for (const double azimuth : lidar.azimuth_deg)
    shifts.push_back(static_cast<int>(std::lround((azimuth - lowest) * lidar.columns / 360.0)));
  return shifts;
}

}  // namespace

std::string ouster_metadata(const LidarModel& lidar) {
  nlohmann::ordered_json json;
  json["base_pn"] = "";
  json["base_sn"] = "";
  json["beam_altitude_angles"] = lidar.altitude_deg;
  json["beam_azimuth_angles"] = lidar.azimuth_deg;
  json["build_date"] = "2022-04-14T21:11:47Z";
  json["build_rev"] = "v2.3.0";
  json["client_version"] = "gvom-sim";
  json["data_format"] = {{"column_window", {0, lidar.columns - 1}},
                         {"columns_per_frame", lidar.columns},
                         {"columns_per_packet", columns_per_packet(lidar)},
                         {"pixel_shift_by_row", pixel_shifts(lidar)},
                         {"pixels_per_column", lidar.beams()},
                         {"udp_profile_imu", "LEGACY"},
                         {"udp_profile_lidar", "RNG15_RFL8_NIR8"}};
  json["hostname"] = "";
  json["image_rev"] = "simulated";
  json["imu_to_sensor_transform"] = {1, 0, 0, 6.253, 0, 1, 0, -11.775, 0, 0, 1, 7.645, 0, 0, 0, 1};
  json["initialization_id"] = 7109750 + lidar.number;
  json["json_calibration_version"] = 4;
  json["lidar_mode"] = std::to_string(lidar.columns) + "x" + std::to_string(lidar.turns_per_s());
  json["lidar_origin_to_beam_origin_mm"] = 1e3 * lidar.beam_origin_m;
  const double rise_mm = 1e3 * lidar.T_sensor_lidar.translation().z();
  json["lidar_to_sensor_transform"] = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, rise_mm, 0, 0, 0, 1};
  json["prod_line"] = "OS-1-" + std::to_string(lidar.beams());
  json["prod_pn"] = "840-103575-06";
  json["prod_sn"] = std::to_string(lidar.serial_number());
  json["proto_rev"] = "";
  json["status"] = "RUNNING";
  json["udp_port_imu"] = lidar.udp_port + 100;
  json["udp_port_lidar"] = lidar.udp_port;
  return json.dump(4) + "\n";
}

}  // namespace gvom::sim
