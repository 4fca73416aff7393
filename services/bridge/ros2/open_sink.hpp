// ROS 2 as one of the bridge's sinks, whether it was built in or not.
#pragma once

#include <memory>

#include <tl/expected.hpp>

#include "services/bridge/sink.hpp"
#include "services/common/config_file.hpp"

namespace gvom::bridge {

/// Whether `bridge.ros2.*` can be done. Errors: a key that cannot be, a gvom that was built without Cyclone
/// DDS.
tl::expected<void, services::ConfigError> check_ros2(const services::VehicleConfig& config);

/// The sink that `bridge.ros2.*` asks for; null where `distro` is empty. Errors as of `check_ros2`. A network
/// that is not there yet is none: the sink looks for it again and again.
tl::expected<std::unique_ptr<Sink>, services::ConfigError> open_ros2_sink(
    const services::VehicleConfig& config);

}  // namespace gvom::bridge
