#include "services/bridge/ros2/open_sink.hpp"

#include <utility>

#include "services/bridge/ros2/ros2_sink.hpp"
#include "services/bridge/ros2/settings.hpp"

namespace gvom::bridge {

tl::expected<void, services::ConfigError> check_ros2(const services::VehicleConfig& config) {
  if (config.bridge.ros2.distro.empty()) return {};
  return ros2_settings(config).map([](const Ros2Settings&) {});
}

tl::expected<std::unique_ptr<Sink>, services::ConfigError> open_ros2_sink(
    const services::VehicleConfig& config) {
  if (config.bridge.ros2.distro.empty()) return nullptr;
  auto settings = ros2_settings(config);
  if (!settings) return tl::unexpected(settings.error());
  return std::make_unique<Ros2Sink>(std::move(*settings));
}

}  // namespace gvom::bridge
