// Recorded odometry: T_odom_base from a file.
#pragma once

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/pose.hpp"

namespace gvom::services {

/// All poses of an `odometry.source`, at least one, stamps strictly increasing:
///
///   tum:FILE                  t x y z qx qy qz qw: seconds, metres
///   euroc:FILE                t,x,y,z,qw,qx,qy,qz,...: nanoseconds, metres
///   kitti:FILE?times=FILE     3x4 matrices row by row, and as many times (see read_stamps)
///   bag:PATH?topic=TOPIC      ROS 2 bags: see read_bag_odometry
///   bag:PATH?tf=PARENT/CHILD
///
/// FILE and PATH are relative to the working directory. '#' begins a comment line; blank lines, a UTF-8
/// byte-order mark and CRLF count for nothing. `tum:` reads EuRoC's ground truth too if its own header says
/// so. Of poses with the same stamp the first is taken. Both are told in `warnings`. Errors are `FILE:LINE:
/// reason`, and the format that the file seems to have: not a number, NaN or infinite, another number of
/// columns, a rotation that is none, time that goes back, stamps too coarse for the poses.
tl::expected<std::vector<StampedPose>, std::string> read_odometry_source(const std::string& source,
                                                                         std::vector<std::string>& warnings);

}  // namespace gvom::services
