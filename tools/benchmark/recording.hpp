// What is measured on: sweeps with their poses.
#pragma once

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/config.hpp"
#include "core/pose.hpp"
#include "core/sweep.hpp"

namespace gvom::bench {

struct Recording {
  std::string name;
  LidarGeometry lidar;
  std::vector<Sweep> sweeps;
  std::vector<Pose> T_odom_base;  ///< One for each sweep; all its returns are of that moment.
  Eigen::Vector3d lap_m = Eigen::Vector3d::Zero();  ///< From the first sweep to where the next lap begins.
};

/// A folder of KITTI's .bin files with its `times.txt`, and odometry (TUM, T_odom_base) that brackets it.
/// @param sensor_height_m of the lidar above base_link
/// Errors name the file.
tl::expected<Recording, std::string> read_recording(const std::string& folder, const std::string& odometry,
                                                    double sensor_height_m);

/// A lidar by its beams, which are evenly spread in elevation.
struct StreetLidar {
  const char* name;
  int beams;
  int azimuths;  ///< Shots of each beam in a turn.
  double lowest_rad;
  double highest_rad;
};
inline constexpr StreetLidar kStreetLidars[] = {{"hdl-64", 64, 2048, -0.43, 0.035},
                                                {"os1-128", 128, 1024, -0.393, 0.393}};

/// A street that a lidar drives along at 11.6 m/s, over bumps: ground, walls, parked cars and poles. It
/// repeats itself after a lap.
Recording make_street(const StreetLidar& lidar);

}  // namespace gvom::bench
