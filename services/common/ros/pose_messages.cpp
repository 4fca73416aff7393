#include "services/common/ros/pose_messages.hpp"

#include <cmath>

#include "services/common/ros/message_parts.hpp"

namespace gvom::ros {
namespace {

PoseRecord pose_of(const ipc::Plan::Point& point) {
  const double half_rad = 0.5 * static_cast<double>(point.yaw_rad);
  return {{point.x_m, point.y_m, static_cast<double>(point.z_m)},
          {0, 0, std::sin(half_rad), std::cos(half_rad)}};
}

}  // namespace

void write_tf(std::int64_t stamp_ns, const PoseRecord& T_odom_base, const Frames& frames,
              std::vector<std::uint8_t>& bytes) {
  CdrWriter out(bytes);
  out.count(1);
  write_header(out, stamp_ns, frames.odom);
  out.text(frames.base);
  write_pose(out, T_odom_base);
}

void write_path(std::int64_t stamp_ns, ipc::Span<const ipc::Plan::Point> points, const Frames& frames,
                std::vector<std::uint8_t>& bytes) {
  CdrWriter out(bytes);
  write_header(out, stamp_ns, frames.odom);
  out.count(points.size());
  for (const ipc::Plan::Point& point : points) {
    write_header(out, stamp_ns, frames.odom);
    write_pose(out, pose_of(point));
  }
}

}  // namespace gvom::ros
