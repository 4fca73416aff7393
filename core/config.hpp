// What can be configured about the map. Default, unit, range and meaning stand on each field and
// nowhere else; the YAML keys carry the fields' names (MAPPING rules R1..R17).
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

namespace gvom {

/// The voxel grid around the vehicle (R1). The defaults are the paper's grid.
struct MapConfig {
  double resolution_xy_m = 0.4;  ///< Voxel edge in x and y, 0.01 .. 10.
  double resolution_z_m = 0.4;   ///< Voxel edge in z, 0.01 .. 10.
  int size_xy = 256;             ///< Voxels in x and in y, a multiple of 8, 8 .. 1024.
  int size_z = 64;               ///< Voxels in z, a multiple of 8, 8 .. 256.
};

/// Which buffer maps make up the fused map (R7).
struct WindowConfig {
  int buffer_size = 8;     ///< Maps kept for each lidar, 1 .. 128.
  double max_age_s = 2.0;  ///< No map is older than this before the newest stamp, 0 .. 3600.
};

/// What is remembered of maps that left the window (R17).
struct MemoryConfig {
  double max_age_s = 5;  ///< Nothing is remembered for longer; 0: nothing at all; 0 .. 60.
};

/// An axis-aligned box in base_link, metres.
struct Box {
  Eigen::Vector3d min_m;
  Eigen::Vector3d max_m;
};

/// The vehicle's own geometry.
struct VehicleGeometry {
  std::optional<Box> body;     ///< Returns inside are the vehicle itself (R2); absent: no body filter.
  double radius_m = 2.0;       ///< Ground is assumed within this distance of base_link (R9), 0 .. 20.
  double base_height_m = 0.0;  ///< base_link above the ground (R9), -5 .. 5.
};

/// How columns become layers (R8..R13).
struct LayersConfig {
  int min_hits = 1;                    ///< Hits that make a voxel occupied (R8), 1 .. 1000.
  double min_obstacle_height_m = 0.5;  ///< Above the column's height (R11), 0 .. 10.
  double max_obstacle_height_m = 2.0;  ///< Above the column's height (R11, R14), 0 .. 50.
  double density_threshold = 0.5;      ///< HARD from here on (R11), 0 .. 1.
  int plane_size = 3;                  ///< N of the N x N plane fit (R12), odd, 3 .. 15.
  double slope_threshold_rad = 0.5;    ///< STEEP from here on (R12), 0 .. 1.5708.
  int search_distance = 20;            ///< Columns searched for a rim (R13), 1 .. 255.
  double negative_threshold_m = 0.5;   ///< A hole this deep matters (R13), 0 .. 20.
};

/// The weights of the cost layer (R16).
struct CostConfig {
  double soft_weight = 1.0;         ///< 0 .. 1000; the three weights must not all be 0.
  double slope_weight = 1.0;        ///< 0 .. 1000.
  double roughness_weight = 1.0;    ///< 0 .. 1000.
  double slope_full_rad = 0.5;      ///< Slope of full cost, > 0 .. 1.5708.
  double roughness_full_m2 = 0.05;  ///< Roughness of full cost, > 0 .. 100.
};

/// Where a lidar sits and which of its returns count (R2, R3). The extrinsic has no default.
struct LidarGeometry {
  Eigen::Isometry3d T_base_sensor = Eigen::Isometry3d::Identity();  ///< Sensor frame to base_link.
  double min_range_m = 1.0;                                         ///< From the sensor (R2), 0 .. 1000.
  double max_range_m = 100.0;                                       ///< From the sensor (R2), 0 .. 1000.
};

/// All that the fused map and its layers depend on.
struct MapperConfig {
  MapConfig map;
  WindowConfig window;
  MemoryConfig memory;
  VehicleGeometry vehicle;
  LayersConfig layers;
  CostConfig cost;
};

}  // namespace gvom
