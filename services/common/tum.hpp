// Odometry recordings in the TUM format: `t x y z qx qy qz qw`, seconds and metres, one pose a line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "core/pose.hpp"

namespace gvom::services {

/// All poses of `path`, at least one, stamps strictly increasing. '#' begins a comment line; blank lines
/// count for nothing. Quaternions whose norm is off by at most 1e-3 are normalised. Errors are `FILE:LINE:
/// reason`: not a number, NaN or infinite, not 8 columns, a quaternion that is none, time that stands still
/// or goes back.
tl::expected<std::vector<StampedPose>, std::string> read_tum(const std::string& path);

/// The same for an `odometry.source`, `tum:FILE`; FILE is relative to the working directory.
tl::expected<std::vector<StampedPose>, std::string> read_odometry_source(const std::string& source);

/// Decimal seconds to nanoseconds, exactly (not through double; digits beyond the ninth decimal are rounded
/// half away from zero). Nothing if `text` is not a decimal number or does not fit.
std::optional<std::int64_t> parse_stamp_ns(std::string_view text);

}  // namespace gvom::services
