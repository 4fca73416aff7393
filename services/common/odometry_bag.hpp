// Recorded odometry out of a ROS 2 bag.
#pragma once

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/pose.hpp"

namespace gvom::services {

/// All poses of `bag:PATH?topic=TOPIC` (nav_msgs/msg/Odometry) or `bag:PATH?tf=PARENT/CHILD[&topic=TOPIC]`
/// (tf2_msgs/msg/TFMessage, of /tf unless told), at least one, stamps strictly increasing: the messages' own,
/// not the recorder's. Between PARENT and CHILD may be other frames, of which one moves; what stands still is
/// taken from /tf_static too.
/// Messages that can't be read, poses that are none (NaN, no rotation), of another child frame than the
/// first, or not newer than those before (a bag that was looped) are left out; `warnings` count them and name
/// the first. Errors: no such bag, topic or frames; no pose in it.
tl::expected<std::vector<StampedPose>, std::string> read_bag_odometry(const std::string& source,
                                                                      std::vector<std::string>& warnings);

}  // namespace gvom::services
