#include "services/bridge/ros2/open_sink.hpp"

namespace gvom::bridge {

tl::expected<std::unique_ptr<Sink>, services::ConfigError> open_ros2_sink(
    const services::VehicleConfig& config) {
  if (config.bridge.ros2.distro.empty()) return nullptr;
  return tl::make_unexpected(services::ConfigError{
      config.path, "bridge.ros2.distro", "this gvom was built without Cyclone DDS (cyclonedds-dev)"});
}

}  // namespace gvom::bridge
