#include "services/bridge/ros2/open_sink.hpp"

namespace gvom::bridge {

tl::expected<void, services::ConfigError> check_ros2(const services::VehicleConfig& config) {
  if (config.bridge.ros2.distro.empty()) return {};
  return tl::make_unexpected(services::ConfigError{
      config.path, "bridge.ros2.distro", "this gvom was built without Cyclone DDS (cyclonedds-dev)"});
}

tl::expected<std::unique_ptr<Sink>, services::ConfigError> open_ros2_sink(
    const services::VehicleConfig& config) {
  return check_ros2(config).map([] { return std::unique_ptr<Sink>(); });
}

}  // namespace gvom::bridge
