// Odometry as a node of ROS 2 publishes it now, to the bus.
#pragma once

#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "ipc/runtime.hpp"
#include "services/common/exit_code.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/odometry_lines.hpp"
#include "services/common/ros/incoming.hpp"

namespace gvom::odometry {

/// Poses out of the messages of one topic, nav_msgs/msg/Odometry.
class OdometryMessages {
 public:
  /// Errors: the message is not what its type says; it is of another child frame than the first; it is no
  /// pose (NaN, no rotation).
  services::PoseResult read(ros::Bytes message);

  /// "base_link in odom"; empty before the first pose.
  [[nodiscard]] std::string frames() const { return frames_; }

 private:
  std::string frames_;
};

/// Whether `source` is one for run_live: `ros2:/TOPIC` (LiveSource).
bool is_live(const std::string& source);

/// What is wrong with such a source, before anything is opened; empty if nothing is.
std::string fault_of(const std::string& source);

/// Publishes until a stop (ok). Poses go on as they come: who uses them judges their order and their jumps.
/// What is no pose, and what another publisher sends while the first one does, is counted, and Health says
/// so. Errors: a network that is not there (unavailable), the bus.
services::ExitCode run_live(const std::string& source, std::uint64_t config_hash, ipc::Runtime& runtime,
                            services::Lifecycle& lifecycle);

}  // namespace gvom::odometry
