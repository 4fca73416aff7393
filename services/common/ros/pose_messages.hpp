// Poses: the vehicle's, and those of a way.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/messages.hpp"
#include "ipc/span.hpp"

namespace gvom::ros {

/// The frames' names, as the vehicle's other software calls them.
struct Frames {
  std::string odom = "odom";
  std::string base = "base_link";
};

/// tf2_msgs/TFMessage: base in odom. Replaces what is in `out`.
void write_tf(std::int64_t stamp_ns, const PoseRecord& T_odom_base, const Frames& frames,
              std::vector<std::uint8_t>& out);

/// nav_msgs/Path in odom: level poses, turned by their yaw.
void write_path(std::int64_t stamp_ns, ipc::Span<const ipc::Plan::Point> points, const Frames& frames,
                std::vector<std::uint8_t>& out);

}  // namespace gvom::ros
