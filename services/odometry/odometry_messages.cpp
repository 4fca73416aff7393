#include "services/odometry/live.hpp"

namespace gvom::odometry {

services::PoseResult OdometryMessages::read(ros::Bytes message) {
  ros::OdometryIn odometry;
  if (const auto read = ros::read_odometry(message, odometry); !read) return tl::unexpected(read.error());
  const std::string frames =
      std::string(odometry.child_frame_id) + " in " + std::string(odometry.header.frame_id);
  if (!frames_.empty() && frames != frames_)
    return tl::unexpected("it is of " + frames + ", not of " + frames_);
  const auto& p = odometry.position_m;
  const auto& q = odometry.orientation_xyzw;
  auto pose = services::make_pose(odometry.header.stamp_ns, {p[0], p[1], p[2]}, {q[3], q[0], q[1], q[2]});
  if (pose) frames_ = frames;
  return pose;
}

bool is_live(const std::string& source) {
  return source.compare(0, 5, "ros2:") == 0;
}

}  // namespace gvom::odometry
