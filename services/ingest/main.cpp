// gvom-ingest: sweeps of one lidar to buffer maps.
#include <spdlog/spdlog.h>

#include <iostream>
#include <utility>

#include "core/open_backend.hpp"
#include "services/common/bus/join.hpp"
#include "services/common/cli.hpp"
#include "services/common/device_trust.hpp"
#include "services/common/lifecycle.hpp"
#include "services/common/log.hpp"
#include "services/ingest/ingest_node.hpp"
#include "services/ingest/source_check.hpp"
#include "services/ingest/source_options.hpp"
#include "services/ingest/udp_ports.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

ExitCode code_of(const ingest::SourceError& error) {
  return error.kind == ingest::SourceError::Kind::unavailable ? ExitCode::unavailable : ExitCode::bad_data;
}

/// Says what is at the source. A port that this lidar's own process has is well.
ExitCode check(const services::LidarConfig& lidar) {
  const auto checked = ingest::check_source(lidar);
  if (checked) {
    for (const std::string& warning : checked->warnings) std::cerr << "warning: " << warning << "\n";
    std::cout << "lidar " << lidar.name << ": " << lidar.source << ": " << checked->found << "\n";
    return ExitCode::ok;
  }
  const bool taken = checked.error().kind == ingest::SourceError::Kind::unavailable;
  const auto port = taken ? ingest::live_port(lidar.source) : std::nullopt;
  const auto owner = port ? ingest::owner_of_port(*port) : std::nullopt;
  if (owner && ingest::is_ingest_of(*owner, lidar.name)) {
    std::cout << "lidar " << lidar.name << ": its process runs (pid " << owner->pid << ") and has port "
              << *port << "\n";
    return ExitCode::ok;
  }
  std::cerr << "lidar " << lidar.name << ": " << checked.error().what;
  if (owner) std::cerr << ": process " << owner->pid << " (" << owner->command << ") has it";
  std::cerr << "\n";
  return code_of(checked.error());
}

ExitCode run(const services::VehicleConfig& config, const services::LidarConfig& lidar,
             services::Lifecycle& lifecycle) {
  auto source = ingest::open_source(lidar.source, ingest::source_options(lidar));
  if (!source) {
    spdlog::error("lidar {}: {}", lidar.name, source.error().what);
    return code_of(source.error());
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
  const services::DeviceTrust trust(lidar.backend, services::device_record_of(runtime->name()));
  auto backend = trust.open([&](Backend which) { return open_voxelizer(which, setup); });
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
                          {std::move(*source), trust, std::move(*backend)});
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
    return ingest::check_given(config, **lidar);
  });
  cli.on_check([&](const services::VehicleConfig& config) {
    return check(*services::find_lidar(config, name).value());
  });
  cli.app().footer(
      "lidars.NAME.source, live: ouster-udp:PORT?meta=FILE, velodyne-udp:PORT?model=M, ros2:/TOPIC;\n"
      "recorded: ouster:FILE.pcap?meta=FILE, velodyne:FILE.pcap?model=M, scans:FOLDER, "
      "bag:PATH?topic=TOPIC\n\n"
      "Examples:\n"
      "  gvom-ingest --config vehicle.yaml --lidar front --check\n"
      "  gvom-ingest --config vehicle.yaml --lidar front --set "
      "lidars.front.source=velodyne-udp:2368?model=VLP-16");
  const auto config = cli.parse(argc, argv);
  if (!config) return services::to_int(config.error());
  services::init_logging("gvom-ingest-" + name);
  return services::to_int(run(*config, *services::find_lidar(*config, name).value(), lifecycle));
}
