// gvom-fusion: buffer maps of all lidars to one map and its layers.
#include <spdlog/spdlog.h>

#include "services/common/bus/join.hpp"
#include "services/common/cli.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"
#include "services/fusion/fusion_node.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

ExitCode run(const services::VehicleConfig& config, services::Lifecycle& lifecycle) {
  auto runtime = services::join_bus("gvom-fusion", lifecycle);
  if (!runtime) return runtime.error();
  auto bus = fusion::Bus::open(*runtime, config);
  if (!bus) {
    spdlog::error("{}", bus.error().message);
    return services::exit_code_of(bus.error());
  }
  if (const auto faulted = runtime->prefault(); !faulted) spdlog::warn("{}", faulted.error().message);
  fusion::FusionNode node(config, *runtime, *bus, lifecycle);
  spdlog::info("fusing {} lidars on the CPU", config.lidars.size());
  return node.run();
}

}  // namespace

int main(int argc, char** argv) {
  services::Lifecycle lifecycle;
  services::Cli cli("gvom-fusion", "Fuses the buffer maps of all lidars and publishes layers.");
  const auto config = cli.parse(argc, argv);
  if (!config) return services::to_int(config.error());
  services::init_logging("gvom-fusion");
  return services::to_int(run(*config, lifecycle));
}
