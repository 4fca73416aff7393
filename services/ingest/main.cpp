// gvom-ingest: sweeps of one lidar to buffer maps.
#include <spdlog/spdlog.h>

#include <utility>

#include "core/open_backend.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/cli.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"
#include "services/ingest/ingest_node.hpp"
#include "services/ingest/source_options.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

ExitCode run(const services::VehicleConfig& config, const services::LidarConfig& lidar,
             services::Lifecycle& lifecycle) {
  auto source = ingest::open_source(lidar.source, ingest::source_options(lidar));
  if (!source) {
    spdlog::error("lidar {}: {}", lidar.name, source.error().what);
    return source.error().kind == ingest::SourceError::Kind::unavailable ? ExitCode::unavailable
                                                                         : ExitCode::bad_data;
  }
  const auto max_returns = static_cast<std::size_t>(lidar.max_returns);
  if (const auto lack = ingest::lack_of_room(lidar.name, max_returns, **source); !lack.empty()) {
    spdlog::error("{}", lack);
    return ExitCode::configuration;
  }
  for (const std::string& warning : (*source)->warnings()) spdlog::warn("{}", warning);
  auto runtime = services::join_bus("gvom-ingest-" + lidar.name, lifecycle);
  if (!runtime) return runtime.error();
  const VoxelizerSetup setup{config.mapper.map, lidar.geometry, config.mapper.vehicle,
                             static_cast<std::size_t>(lidar.max_returns), services::ready_payloads(*runtime)};
  auto backend = open_voxelizer(lidar.backend, setup);
  if (!backend) {
    spdlog::error("lidars.{}.backend cuda: {}", lidar.name, backend.error().what);
    return ExitCode::unavailable;
  }
  spdlog::info("{} from {} on {}: {}", lidar.name, lidar.source, backend->name, backend->details);
  auto bus = ingest::Bus::open(*runtime, config, lidar.name);
  if (!bus) {
    spdlog::error("{}", bus.error().message);
    return services::exit_code_of(bus.error());
  }
  ingest::IngestNode node(config, lidar, *runtime, *bus, lifecycle,
                          {std::move(*source), std::move(*backend)});
  return node.run();
}

}  // namespace

int main(int argc, char** argv) {
  services::Lifecycle lifecycle(services::kLeaveWithin);
  services::Cli cli("gvom-ingest", "Maps the sweeps of one lidar and publishes buffer maps.");
  std::string name;
  cli.app().add_option("--lidar", name, "which of the vehicle's lidars")->required();
  cli.also_check([&](const services::VehicleConfig& config) -> tl::expected<void, services::ConfigError> {
    const auto lidar = find_lidar(config, name);
    if (!lidar) return tl::unexpected(lidar.error());
    if (!(*lidar)->source.empty()) return {};
    return tl::unexpected(services::ConfigError{config.path, "lidars." + name + ".source",
                                                "is empty; give one in the file or by --set"});
  });
  const auto config = cli.parse(argc, argv);
  if (!config) return services::to_int(config.error());
  services::init_logging("gvom-ingest-" + name);
  return services::to_int(run(*config, *services::find_lidar(*config, name).value(), lifecycle));
}
