// A pose as one line of a recording gives it, in each of the formats that are read.
#pragma once

#include <cstdint>
#include <string>

#include <tl/expected.hpp>

#include "core/pose.hpp"

namespace gvom::services {

using PoseResult = tl::expected<StampedPose, std::string>;

/// A quaternion whose norm is off by at most 1e-3 is normalised; any other, and what is not finite, is an
/// error.
PoseResult make_pose(std::int64_t stamp_ns, const Eigen::Vector3d& position_m,
                     const Eigen::Quaterniond& rotation);

/// `t x y z qx qy qz qw`, seconds and metres. Errors of all three: a number is missing or none or not finite,
/// a rotation that is none. Quaternions whose norm is off by at most 1e-3 are normalised.
PoseResult parse_tum_line(const std::string& line);

/// `t,x,y,z,qw,qx,qy,qz` and whatever follows (EuRoC's ground truth), nanoseconds and metres.
PoseResult parse_euroc_line(const std::string& line);

/// Twelve numbers, the rows of a 3x4 matrix; the stamp is 0.
PoseResult parse_kitti_line(const std::string& line);

/// True for the line of column names that EuRoC's ground truth begins with.
bool is_euroc_header(const std::string& line);

/// False if `comment` names columns, of which the fifth is not qw.
bool may_head_euroc(const std::string& comment);

/// What `line`, the first that is no comment, and `header`, the last comment before it, look like, and what
/// to do about it, in words; empty if that is not known.
std::string recognised_format(const std::string& header, const std::string& line);

}  // namespace gvom::services
