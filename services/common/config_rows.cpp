#include "services/common/config_table.hpp"

#include <algorithm>

#include "ipc/messages.hpp"

namespace gvom::services {

namespace {

using V = VehicleConfig;
using L = LidarConfig;

constexpr double kHalfPi = 1.5708;
constexpr double kTurn = 6.2832;
constexpr bool kRequired = true;
constexpr bool kOptional = false;

/// Up to the vehicle's own geometry.
std::vector<VehicleRow> map_rows() {
  return {
      {{"name", "", Rule::identifier, 0, 0, kRequired, "of the vehicle"},
       [](V& c) -> Field { return &c.name; }},

      {{"map.resolution_xy_m", "m", Rule::range, 0.01, 10, kOptional, "voxel edge in x and y (R1)"},
       [](V& c) -> Field { return &c.mapper.map.resolution_xy_m; }},
      {{"map.resolution_z_m", "m", Rule::range, 0.01, 10, kOptional, "voxel edge in z (R1)"},
       [](V& c) -> Field { return &c.mapper.map.resolution_z_m; }},
      {{"map.size_xy", "voxels", Rule::multiple_of_8, 8, 1024, kOptional,
        "the grid's size in x and in y (R1)"},
       [](V& c) -> Field { return &c.mapper.map.size_xy; }},
      {{"map.size_z", "voxels", Rule::multiple_of_8, 8, 256, kOptional, "the grid's size in z (R1)"},
       [](V& c) -> Field { return &c.mapper.map.size_z; }},

      {{"window.buffer_size", "maps", Rule::range, 1, 128, kOptional, "maps kept for each lidar (R7)"},
       [](V& c) -> Field { return &c.mapper.window.buffer_size; }},
      {{"window.max_age_s", "s", Rule::range, 0, 3600, kOptional,
        "no map is older than this before the newest stamp (R7)"},
       [](V& c) -> Field { return &c.mapper.window.max_age_s; }},
      {{"memory.max_age_s", "s", Rule::range, 0, 60, kOptional,
        "what left the window is remembered for so long, to the next 0.54 s; 0: not at all (R17)"},
       [](V& c) -> Field { return &c.mapper.memory.max_age_s; }},

      {{"vehicle.body_min_m", "m", Rule::corner, -100, 100, kOptional,
        "returns from here to body_max_m in base_link are the vehicle itself (R2)"},
       [](V& c) -> Field {
         return BoxCorner{&c.mapper.vehicle.body, &Box::min_m};
       }},
      {{"vehicle.body_max_m", "m", Rule::corner, -100, 100, kOptional,
        "the other corner of that box; both or none"},
       [](V& c) -> Field {
         return BoxCorner{&c.mapper.vehicle.body, &Box::max_m};
       }},
      {{"vehicle.radius_m", "m", Rule::range, 0, 20, kOptional,
        "ground is assumed within this distance of base_link (R9)"},
       [](V& c) -> Field { return &c.mapper.vehicle.radius_m; }},
      {{"vehicle.base_height_m", "m", Rule::range, -5, 5, kOptional, "base_link above the ground (R9)"},
       [](V& c) -> Field { return &c.mapper.vehicle.base_height_m; }},
  };
}

std::vector<VehicleRow> layer_rows() {
  return {
      {{"layers.min_hits", "hits", Rule::range, 1, 1000, kOptional, "that make a voxel occupied (R8)"},
       [](V& c) -> Field { return &c.mapper.layers.min_hits; }},
      {{"layers.min_obstacle_height_m", "m", Rule::range, 0, 10, kOptional,
        "obstacles begin this far above the column's height (R11)"},
       [](V& c) -> Field { return &c.mapper.layers.min_obstacle_height_m; }},
      {{"layers.max_obstacle_height_m", "m", Rule::range, 0, 50, kOptional,
        "and end here; what is above is clearance (R11, R14)"},
       [](V& c) -> Field { return &c.mapper.layers.max_obstacle_height_m; }},
      {{"layers.density_threshold", "", Rule::range, 0, 1, kOptional,
        "share of the rays in the obstacle voxels of 3 x 3 columns, less a hit each, that is HARD (R11)"},
       [](V& c) -> Field { return &c.mapper.layers.density_threshold; }},
      {{"layers.plane_size", "columns", Rule::odd, 3, 15, kOptional, "edge of the plane fit (R12)"},
       [](V& c) -> Field { return &c.mapper.layers.plane_size; }},
      {{"layers.slope_threshold_rad", "rad", Rule::range, 0, kHalfPi, kOptional, "slope that is STEEP (R12)"},
       [](V& c) -> Field { return &c.mapper.layers.slope_threshold_rad; }},
      {{"layers.search_distance", "columns", Rule::range, 1, 255, kOptional,
        "how far a hole's rim and the ground beyond are searched; an edge's two fifths of it (R13)"},
       [](V& c) -> Field { return &c.mapper.layers.search_distance; }},
      {{"layers.negative_threshold_m", "m", Rule::range, 0, 20, kOptional,
        "depth of a hole that matters: 0.08 of it must show, 0.34 behind an edge, plus noise (R13)"},
       [](V& c) -> Field { return &c.mapper.layers.negative_threshold_m; }},

      {{"cost.soft_weight", "", Rule::range, 0, 1000, kOptional,
        "of obstacle density (R16); not all three may be 0"},
       [](V& c) -> Field { return &c.mapper.cost.soft_weight; }},
      {{"cost.slope_weight", "", Rule::range, 0, 1000, kOptional, "of slope (R16)"},
       [](V& c) -> Field { return &c.mapper.cost.slope_weight; }},
      {{"cost.roughness_weight", "", Rule::range, 0, 1000, kOptional, "of roughness (R16)"},
       [](V& c) -> Field { return &c.mapper.cost.roughness_weight; }},
      {{"cost.slope_full_rad", "rad", Rule::above_min, 0, kHalfPi, kOptional, "slope of full cost (R16)"},
       [](V& c) -> Field { return &c.mapper.cost.slope_full_rad; }},
      {{"cost.roughness_full_m2", "m^2", Rule::above_min, 0, 100, kOptional, "roughness of full cost (R16)"},
       [](V& c) -> Field { return &c.mapper.cost.roughness_full_m2; }},
  };
}

std::vector<VehicleRow> process_rows() {
  return {
      {{"fusion.backend", "", Rule::choice, 0, 0, kOptional,
        "what fuses and makes the layers; auto: a GPU if one can be used and keeps working, else the CPU"},
       [](V& c) -> Field { return &c.fusion.backend; }},
      {{"fusion.rate_hz", "Hz", Rule::range, 0, 100, kOptional, "of the layers; 0: on each map"},
       [](V& c) -> Field { return &c.fusion.rate_hz; }},
      {{"fusion.voxel_rate_hz", "Hz", Rule::range, 0, 100, kOptional,
        "of the voxel map, at most, and only if somebody reads it; 0: never"},
       [](V& c) -> Field { return &c.fusion.voxel_rate_hz; }},
      {{"fusion.missing_after_s", "s", Rule::range, 0.05, 60, kOptional,
        "a lidar without a map newer than this before the newest of all is named as missing"},
       [](V& c) -> Field { return &c.fusion.missing_after_s; }},

      {{"ipc.max_planners", "processes", Rule::range, 1, 32, kOptional,
        "that read layers or voxel maps at the same time"},
       [](V& c) -> Field { return &c.ipc.max_planners; }},

      {{"odometry.source", "", Rule::text, 0, 0, kOptional,
        "tum:FILE, euroc:FILE, kitti:FILE?times=FILE, bag:PATH?topic=TOPIC or bag:PATH?tf=PARENT/CHILD, "
        "relative to the working directory; ros2:/TOPIC, ros2:/tf?tf=PARENT/CHILD live; empty: by the "
        "command line"},
       [](V& c) -> Field { return &c.odometry.source; }},
      {{"odometry.timeout_s", "s", Rule::range, 0.01, 60, kOptional,
        "a live sweep waits this long for the odometry that brackets it (R3)"},
       [](V& c) -> Field { return &c.odometry.timeout_s; }},
      {{"odometry.max_gap_s", "s", Rule::range, 0.05, 60, kOptional,
        "a sweep within a longer gap between two poses is not mapped, live or recorded"},
       [](V& c) -> Field { return &c.odometry.max_gap_s; }},
      {{"odometry.max_speed_mps", "m/s", Rule::range, 1, 1000, kOptional,
        "odometry that moves faster from pose to pose has jumped: the map begins anew, live or recorded"},
       [](V& c) -> Field { return &c.odometry.max_speed_mps; }},
      {{"odometry.max_clock_offset_s", "s", Rule::range, 0.05, 3600, kOptional,
        "a live lidar whose clock is farther from the odometry's is not mapped; odometry that comes late "
        "counts"},
       [](V& c) -> Field { return &c.odometry.max_clock_offset_s; }},
  };
}

}  // namespace

const std::vector<VehicleRow>& vehicle_rows() {
  static const std::vector<VehicleRow> all = [] {
    std::vector<VehicleRow> rows;
    for (const auto& part :
         {map_rows(), limit_rows(), layer_rows(), process_rows(), planner_rows(), bridge_rows()})
      rows.insert(rows.end(), part.begin(), part.end());
    return rows;
  }();
  return all;
}

const std::vector<LidarRow>& lidar_rows() {
  static const std::vector<LidarRow> rows = {
      {{"source", "", Rule::text, 0, 0, kOptional,
        "source URI, files relative to the working directory; empty: by the command line"},
       [](L& c) -> Field { return &c.source; }},
      {{"T_base_sensor.x", "m", Rule::range, -100, 100, kRequired, "the sensor in base_link (R3)"},
       [](L& c) -> Field { return &c.extrinsic.x_m; }},
      {{"T_base_sensor.y", "m", Rule::range, -100, 100, kRequired, "likewise"},
       [](L& c) -> Field { return &c.extrinsic.y_m; }},
      {{"T_base_sensor.z", "m", Rule::range, -100, 100, kRequired, "likewise"},
       [](L& c) -> Field { return &c.extrinsic.z_m; }},
      {{"T_base_sensor.roll", "rad", Rule::range, -kTurn, kTurn, kRequired,
        "R = Rz(yaw) Ry(pitch) Rx(roll): about x first; positive leans to the right"},
       [](L& c) -> Field { return &c.extrinsic.roll_rad; }},
      {{"T_base_sensor.pitch", "rad", Rule::range, -kTurn, kTurn, kRequired, "positive looks down"},
       [](L& c) -> Field { return &c.extrinsic.pitch_rad; }},
      {{"T_base_sensor.yaw", "rad", Rule::range, -kTurn, kTurn, kRequired, "positive looks to the left"},
       [](L& c) -> Field { return &c.extrinsic.yaw_rad; }},
      {{"min_range_m", "m", Rule::range, 0, 1000, kOptional, "nearer returns are dropped (R2)"},
       [](L& c) -> Field { return &c.geometry.min_range_m; }},
      {{"max_range_m", "m", Rule::range, 0, 1000, kOptional, "farther returns are dropped (R2)"},
       [](L& c) -> Field { return &c.geometry.max_range_m; }},
      {{"min_sweep_fraction", "", Rule::range, 0, 1, kOptional,
        "sweeps with less than this of their columns are dropped"},
       [](L& c) -> Field { return &c.min_sweep_fraction; }},
      {{"max_returns", "returns", Rule::range, 1, 4194304, kOptional,
        "room for one sweep; more are dropped and counted"},
       [](L& c) -> Field { return &c.max_returns; }},
      {{"clock", "", Rule::clock, 0, 0, kOptional,
        "of its stamps: sensor's own, or by the arrival of its packets, smoothed to the sensor's rate (Unix "
        "time)"},
       [](L& c) -> Field { return &c.clock; }},
      {{"clock_offset_s", "s", Rule::range, -4e9, 4e9, kOptional, "added to its stamps"},
       [](L& c) -> Field { return &c.clock_offset_s; }},
      {{"backend", "", Rule::choice, 0, 0, kOptional,
        "what voxelizes; the CPU keeps up with one lidar, and a CUDA context costs each process several "
        "hundred MB of GPU memory"},
       [](L& c) -> Field { return &c.backend; }},
  };
  return rows;
}

bool is_identifier(const std::string& text) {
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !text.empty() && text.size() < ipc::kNameLength && std::all_of(text.begin(), text.end(), allowed);
}

}  // namespace gvom::services
