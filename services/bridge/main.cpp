// gvom-bridge: what is on the bus, for ROS 2, Foxglove, browsers and files.
#include <spdlog/spdlog.h>

#include <chrono>

#include "services/bridge/bridge_node.hpp"
#include "services/bridge/foxglove_server.hpp"
#include "services/bridge/mcap_recorder.hpp"
#include "services/bridge/ros2/open_sink.hpp"
#include "services/bridge/web.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/cli.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"

namespace {

using namespace gvom;
using services::ConfigError;
using services::ExitCode;

constexpr const char* kName = "gvom-bridge";
/// It finishes the file that it records.
constexpr std::chrono::seconds kLeaveWithin{4};

/// The sinks that the configuration asks for.
tl::expected<bridge::Sinks, ConfigError> open_sinks(const services::VehicleConfig& config) {
  bridge::Sinks sinks;
  const bridge::FoxgloveConfig& foxglove = config.bridge.foxglove;
  if (!foxglove.address.empty()) {
    bridge::FoxgloveOptions options;
    options.vehicle = "gvom " + config.name;
    options.address = foxglove.address;
    options.port = static_cast<std::uint16_t>(foxglove.port);
    options.origins = bridge::split_list(foxglove.origins);
    options.page = foxglove.page.empty() ? bridge::installed_page() : foxglove.page;
    auto server = bridge::FoxgloveServer::start(std::move(options));
    if (!server) return tl::unexpected(ConfigError{config.path, "bridge.foxglove.address", server.error()});
    sinks.push_back(std::move(*server));
  }
  if (!config.bridge.mcap.folder.empty()) {
    auto topics = bridge::recorded_topics(config);
    if (!topics) return tl::unexpected(topics.error());
    bridge::RecorderOptions options;
    options.folder = config.bridge.mcap.folder;
    options.split_bytes = static_cast<std::uint64_t>(config.bridge.mcap.split_mb) * 1'000'000;
    options.min_free_bytes = static_cast<std::uint64_t>(config.bridge.mcap.min_free_mb) * 1'000'000;
    options.topics = std::move(*topics);
    sinks.push_back(std::make_unique<bridge::McapRecorder>(std::move(options)));
  }
  auto ros2 = bridge::open_ros2_sink(config);
  if (!ros2) return tl::unexpected(ros2.error());
  if (*ros2 != nullptr) sinks.push_back(std::move(*ros2));
  return sinks;
}

/// What only the bridge can say of its keys.
tl::expected<void, ConfigError> check(const services::VehicleConfig& config) {
  if (auto names = bridge::check_names(config); !names) return names;
  const bridge::BridgeConfig& keys = config.bridge;
  if (keys.foxglove.address.empty() && keys.mcap.folder.empty() && keys.ros2.distro.empty())
    return tl::unexpected(ConfigError{config.path, "bridge",
                                      "nothing to do: no foxglove.address, no mcap.folder, no ros2.distro"});
  return bridge::check_ros2(config);
}

ExitCode run(const services::VehicleConfig& config, services::Lifecycle& lifecycle) {
  auto runtime = services::join_bus(kName, lifecycle);
  if (!runtime) return runtime.error();
  auto bus = bridge::Bus::open(*runtime);
  if (!bus) {
    spdlog::error("{}", bus.error().message);
    return services::exit_code_of(bus.error());
  }
  const auto sinks = open_sinks(config);
  if (!sinks) {
    spdlog::error("{}", sinks.error().text());
    return ExitCode::configuration;
  }
  return bridge::BridgeNode(config, bridge::message_settings(config).value(), *bus, *sinks, lifecycle).run();
}

}  // namespace

int main(int argc, char** argv) {
  services::Lifecycle lifecycle(kLeaveWithin);
  services::Cli cli(
      kName, "Sends maps, plans and Health to ROS 2, Foxglove and browsers, and records them as MCAP.");
  cli.also_check(check);
  cli.app().footer("Example:\n  gvom-bridge --config vehicle.yaml --set bridge.mcap.folder=recordings");
  const auto config = cli.parse(argc, argv);
  if (!config) return services::to_int(config.error());
  services::init_logging(kName);
  return services::to_int(run(*config, lifecycle));
}
