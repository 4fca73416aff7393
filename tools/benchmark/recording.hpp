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

  /// The sweep of tick `k` of an endless drive to the recording's end and back: 0, 1, .., n - 1, n - 2, ..,
  /// 1, 0, 1, .. So the scene stays the same however many ticks there are, and the vehicle always moves.
  [[nodiscard]] std::size_t sweep_of_tick(std::size_t k) const {
    if (sweeps.size() == 1) return 0;
    const std::size_t turn = sweeps.size() - 1;
    const std::size_t place = k % (2 * turn);
    return place <= turn ? place : 2 * turn - place;
  }
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

/// A street that a lidar drives along: ground, walls, parked cars and poles.
Recording make_street(const StreetLidar& lidar);

}  // namespace gvom::bench
