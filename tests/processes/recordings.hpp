// What the processes replay: a simulated drive, or the real street if it is there.
#pragma once

#include <optional>
#include <string>

#include "tests/processes/graph.hpp"

namespace gvom::test {

/// How fast the simulated vehicle goes if nothing else is said.
inline constexpr double kSpeed_mps = 5;
/// So slow that the grid stays where it is for as long as a test lasts.
inline constexpr double kCrawling_mps = 0.1;

/// The simulated vehicle's two lidars, `front` and `rear`; logs go to FOLDER, and no recording is there.
Vehicle two_lidars(const std::string& folder);

/// The simulated vehicle of two lidars, `front` and `rear`, and its drive of so many seconds in FOLDER.
Vehicle simulated(const std::string& folder, double seconds, double speed_mps = kSpeed_mps);

/// A vehicle with the simulated one's lidar `front` alone, its recording made by `simulated` in FOLDER.
Vehicle front_only(const std::string& folder);

/// The folder of the KITTI recording. Nothing, and a loud warning, if it is not there.
std::optional<std::string> kitti_recording();

/// The KITTI car with its one lidar `top`; logs go to FOLDER.
Vehicle kitti(const std::string& folder, const std::string& recording);

/// One lidar each, all at the place of KITTI's: `sources` are names and URIs. Nothing is remembered: each map
/// tells of its own lowest voxels (R17), so that halves of a sweep tell less than the whole.
Vehicle roof_lidars(const std::string& folder, const std::string& odometry,
                    const std::vector<std::pair<std::string, std::string>>& sources);

/// A plain scans folder of the drive in FOLDER's front lidar: FOLDER/scans, one stamp for each sweep.
std::string scans_of_simulated(const std::string& folder);

}  // namespace gvom::test
