// gvom-fusion: buffer maps of all lidars to one map and its layers.
#include <spdlog/spdlog.h>

#include <utility>

#include "core/open_backend.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/bus/pool_spec.hpp"
#include "services/common/cli.hpp"
#include "services/common/device_trust.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"
#include "services/fusion/fusion_node.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

FusionSetup setup_of(const services::VehicleConfig& config, const HostMemory& shared) {
  FusionSetup setup;
  setup.config = config.mapper;
  setup.lidars = static_cast<int>(config.lidars.size());
  setup.max_returns = static_cast<std::size_t>(services::pool_spec(config).max_returns);
  setup.shared = shared;
  return setup;
}

ExitCode run(const services::VehicleConfig& config, services::Lifecycle& lifecycle) {
  auto runtime = services::join_bus("gvom-fusion", lifecycle);
  if (!runtime) return runtime.error();
  const services::DeviceTrust trust(config.fusion.backend, services::device_record_of(runtime->name()));
  const FusionSetup setup = setup_of(config, services::ready_payloads(*runtime));
  auto backend = trust.open([&](Backend which) { return open_fusion(which, setup); });
  if (!backend) {
    spdlog::error("fusion.backend cuda: {}", backend.error().what);
    return ExitCode::unavailable;
  }
  spdlog::info("fusing {} lidars on {}: {}", config.lidars.size(), backend->name, backend->details);
  auto bus = fusion::Bus::open(*runtime, config);
  if (!bus) {
    spdlog::error("{}", bus.error().message);
    return services::exit_code_of(bus.error());
  }
  fusion::FusionNode node(config, *runtime, *bus, lifecycle, trust, std::move(*backend));
  return node.run();
}

}  // namespace

int main(int argc, char** argv) {
  services::Lifecycle lifecycle(services::kLeaveWithin);
  services::Cli cli("gvom-fusion", "Fuses the buffer maps of all lidars and publishes layers.");
  cli.app().footer("Example:\n  gvom-fusion --config vehicle.yaml --set fusion.rate_hz=10");
  const auto config = cli.parse(argc, argv);
  if (!config) return services::to_int(config.error());
  services::init_logging("gvom-fusion");
  return services::to_int(run(*config, lifecycle));
}
