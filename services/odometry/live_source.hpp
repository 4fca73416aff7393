// `ros2:/TOPIC` as a source of odometry.
#pragma once

#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "services/common/dds/network_options.hpp"
#include "services/common/odometry_tf.hpp"

namespace gvom::odometry {

struct LiveSource {
  std::string topic;                   ///< nav_msgs/msg/Odometry; with `tf` tf2_msgs/msg/TFMessage.
  std::optional<services::Frames> tf;  ///< `?tf=PARENT/CHILD`; links that stand come on `topic` + "_static".
  dds::ParticipantOptions network;     ///< By dds::kNetworkOptions.
};

/// Errors: what is wrong with it, in words; nothing is opened.
tl::expected<LiveSource, std::string> parse_live_source(const std::string& source);

}  // namespace gvom::odometry
