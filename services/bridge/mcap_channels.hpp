// The bridge's topics as channels of an MCAP file.
#pragma once

#include "services/bridge/topic.hpp"
#include "services/common/mcap/mcap_writer.hpp"

namespace gvom::bridge {

/// With its schema, and the quality of service that ROS 2 is offered: who plays the file offers the same.
mcap::OutChannel mcap_channel(const Topic& topic);

}  // namespace gvom::bridge
