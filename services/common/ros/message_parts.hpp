// The parts that many ROS messages have. Internal to services/common/ros.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/format/grid.hpp"
#include "services/common/ros/cdr_writer.hpp"

namespace gvom::ros {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// Seconds are rounded down, so that nanoseconds are never negative; beyond 2038 they wrap, as ROS's do.
inline void write_time(CdrWriter& out, std::int64_t stamp_ns) {
  std::int64_t seconds = stamp_ns / kSecond_ns, rest_ns = stamp_ns % kSecond_ns;
  if (rest_ns < 0) --seconds, rest_ns += kSecond_ns;
  out.number(static_cast<std::int32_t>(seconds));
  out.number(static_cast<std::uint32_t>(rest_ns));
}

/// std_msgs/Header.
inline void write_header(CdrWriter& out, std::int64_t stamp_ns, std::string_view frame) {
  write_time(out, stamp_ns);
  out.text(frame);
}

/// geometry_msgs/Pose, and geometry_msgs/Transform, which has the same bytes.
inline void write_pose(CdrWriter& out, const PoseRecord& pose) {
  for (const double value : pose.position_m) out.number(value);
  for (const double value : pose.orientation_xyzw) out.number(value);
}

/// Not turned.
inline PoseRecord level_pose(double x_m, double y_m, double z_m) {
  return {{x_m, y_m, z_m}, {0, 0, 0, 1}};
}

}  // namespace gvom::ros
