// gvom-map: recordings to maps in one process, without the bus. Scripts rely on what it writes.
#include <spdlog/spdlog.h>

#include <set>
#include <string>
#include <vector>

#include "services/common/cli.hpp"
#include "services/common/log.hpp"
#include "services/common/vehicle_config.hpp"
#include "services/ingest/loss_words.hpp"
#include "tools/map/bag_sources.hpp"
#include "tools/map/map_writer.hpp"
#include "tools/map/offline.hpp"
#include "tools/map/progress.hpp"

namespace {

using gvom::services::ExitCode;
using gvom::services::to_int;

struct Options {
  std::vector<std::string> sources;
  std::string odometry;
  std::string bag;
  gvom::tools::MapWriterOptions maps;
  bool no_deskew = false;
  std::string backend;
};

// `NAME=URI` for the vehicle's lidars; the exit code for what is wrong with them.
ExitCode apply_sources(const std::vector<std::string>& sources, gvom::services::VehicleConfig& config) {
  for (const std::string& source : sources) {
    const std::size_t equals = source.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == source.size()) {
      spdlog::error("--source {}: expected NAME=URI", source);
      return ExitCode::usage;
    }
    const auto lidar = gvom::services::find_lidar(config, source.substr(0, equals));
    if (!lidar) {
      spdlog::error("--source {}: {}", source, lidar.error().text());
      return ExitCode::configuration;
    }
    config.lidars[static_cast<std::size_t>(*lidar - config.lidars.data())].source = source.substr(equals + 1);
  }
  return ExitCode::ok;
}

/// Those that came since the last call; `told`: for each lidar, how many were said.
void say_warnings(const gvom::tools::OfflineMapper& mapper, std::vector<std::size_t>& told,
                  gvom::tools::Progress& progress) {
  for (std::size_t i = 0; i < told.size(); ++i) {
    const auto& lidar = mapper.lidars()[i];
    const std::vector<std::string>& warnings = lidar.source->warnings();
    if (told[i] < warnings.size()) progress.clear();
    while (told[i] < warnings.size()) spdlog::warn("lidar {}: {}", lidar.name, warnings[told[i]++]);
  }
}

/// Of fusion and all lidars.
void apply_backend(gvom::Backend backend, gvom::services::VehicleConfig& config) {
  config.fusion.backend = backend;
  for (gvom::services::LidarConfig& lidar : config.lidars) lidar.backend = backend;
}

void say_backends(const gvom::tools::OfflineMapper& mapper) {
  for (const auto& lidar : mapper.lidars())
    spdlog::info("lidar {} on {}: {}", lidar.name, lidar.backend.name, lidar.backend.details);
  spdlog::info("fusion on {}: {}", mapper.fusion_backend().name, mapper.fusion_backend().details);
}

/// Where the newest sweeps found the ground, if that is not where the vehicle's file puts it.
void say_grounds(const gvom::tools::OfflineMapper& mapper) {
  for (const auto& lidar : mapper.lidars()) {
    gvom::services::Words words;
    lidar.ground->describe(words);
    if (!words.empty()) spdlog::warn("lidar {}: {}", lidar.name, words.text());
  }
}

/// Why there are fewer maps than sweeps.
void say_losses(const gvom::tools::OfflineMapper& mapper, const gvom::services::VehicleConfig& config) {
  for (const auto& lidar : mapper.lidars()) {
    const auto& counters = lidar.source->counters();
    auto lines = gvom::ingest::explain(counters, *gvom::services::find_lidar(config, lidar.name).value());
    for (std::string& line : gvom::ingest::explain(lidar.losses, mapper.odometry()))
      lines.push_back(std::move(line));
    for (std::string& line : gvom::tools::explain(lidar.refused)) lines.push_back(std::move(line));
    for (const std::string& line : lines) spdlog::warn("lidar {}: {}", lidar.name, line);
  }
}

/// Maps what there is; the code of what ended it.
ExitCode map_all(gvom::tools::OfflineMapper& mapper, gvom::tools::MapWriter& maps) {
  std::vector<std::size_t> told(mapper.lidars().size(), 0);
  gvom::tools::MappedSweep sweep;
  gvom::tools::Progress progress(mapper.odometry().span());
  ExitCode code = ExitCode::ok;
  for (;;) {
    say_warnings(mapper, told, progress);
    const auto mapped = mapper.next(sweep);
    if (!mapped) {
      progress.clear();
      spdlog::error("{}", mapped.error().what);
      code = mapped.error().code;
      if (code != ExitCode::bad_data) return code;
      continue;  // one recording broke off; the others go on
    }
    if (*mapped) progress.mapped(sweep.stamp_ns);
    if (const auto written = *mapped ? maps.take(sweep) : maps.finish(); !written) {
      progress.clear();
      spdlog::error("{}", written.error());
      static_cast<void>(maps.finish());  // what can be closed: its words would be the same
      return ExitCode::unavailable;
    }
    if (!*mapped) return code;
  }
}

int run(const gvom::services::VehicleConfig& config, const Options& options) {
  auto mapper = gvom::tools::OfflineMapper::open(config, options.odometry, !options.no_deskew);
  if (!mapper) {
    spdlog::error("{}", mapper.error().what);
    return to_int(mapper.error().code);
  }
  for (const std::string& warning : mapper->odometry_warnings()) spdlog::warn("{}", warning);
  say_backends(*mapper);
  auto maps = gvom::tools::MapWriter::open(options.maps, *mapper, config);
  if (!maps) {
    spdlog::error("{}", maps.error());
    return to_int(ExitCode::unavailable);
  }
  const ExitCode code = map_all(*mapper, *maps);
  if (code == ExitCode::unavailable) return to_int(code);
  say_losses(*mapper, config);
  say_grounds(*mapper);
  spdlog::info("{} maps in {}; {} sweeps without odometry around them, {} maps refused", maps->maps(),
               options.maps.out.empty() ? options.maps.mcap : options.maps.out,
               mapper->sweeps_without_odometry(), mapper->maps_refused());
  return to_int(maps->maps() == 0 && code == ExitCode::ok ? ExitCode::bad_data : code);
}

/// The bag that the vehicle's file leaves open, for the lidars and the odometry.
ExitCode apply_bag(Options& options, gvom::services::VehicleConfig& config) {
  if (options.bag.empty()) return ExitCode::ok;
  const bool odometry = gvom::tools::fill_bag(options.odometry, options.bag);
  if (gvom::tools::fill_bag(config, options.bag) > 0 || odometry) return ExitCode::ok;
  spdlog::error(
      "--bag {}: no source of the vehicle's file says bag:?topic=... (gvomctl bag {} prints the lines)",
      options.bag, options.bag);
  return ExitCode::usage;
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--source", options.sources, "NAME=URI: the recording of one of the vehicle's lidars");
  app.add_option("--bag", options.bag,
                 "the ROS 2 bag (folder, .db3 or .mcap) of all sources that say bag:?topic=TOPIC")
      ->type_name("PATH");
  app.add_option(
      "--odometry", options.odometry,
      "tum:FILE, euroc:FILE, kitti:FILE?times=FILE, bag:PATH?topic=TOPIC, bag:PATH?tf=PARENT/CHILD, or "
      "static: the vehicle stands at the origin (default: odometry.source)");
  app.add_option("--out", options.maps.out, "folder for the maps, 000000 and up");
  app.add_option("--mcap", options.maps.mcap,
                 "one file of the maps for Foxglove, as gvom-bridge records them")
      ->type_name("FILE.mcap");
  app.add_option(
         "--every", options.maps.every_s,
         "write a map only each so many seconds of the recording, and the last one (default: each sweep's)")
      ->type_name("S")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--pictures", options.maps.pictures,
                 "folder for a montage of each map and all layers of the last one")
      ->type_name("DIR");
  app.add_flag("--voxels", options.maps.voxels, "write the fused voxels too");
  app.add_flag("--no-deskew", options.no_deskew,
               "give all returns of a sweep its stamp (R3 off, for comparison)");
  app.add_option("--backend", options.backend,
                 "of fusion and all lidars, instead of fusion.backend and lidars.*.backend")
      ->check(CLI::IsMember(std::set<std::string>{"auto", "cpu", "cuda"}));
  app.footer(
      "Examples:\n  gvom-map --config vehicle.yaml --source top=scans:FOLDER --odometry tum:odometry.tum "
      "--out maps --voxels\n"
      "  gvom-map --config vehicle.yaml --bag FOLDER --out maps --every 1 --pictures pictures");
}

}  // namespace

int main(int argc, char** argv) {
  gvom::services::init_logging("gvom-map");
  gvom::services::Cli cli("gvom-map", "Maps recordings in one process: a folder of layers after each sweep.");
  Options options;
  add_options(cli.app(), options);
  auto config = cli.parse(argc, argv);
  if (!config) return to_int(config.error());
  if (options.maps.out.empty() && (options.maps.mcap.empty() || !options.maps.pictures.empty())) {
    spdlog::error(options.maps.pictures.empty() ? "--out DIR or --mcap FILE is missing"
                                                : "--pictures DIR needs --out DIR");
    return to_int(ExitCode::usage);
  }
  if (const ExitCode code = apply_sources(options.sources, *config); code != ExitCode::ok)
    return to_int(code);
  if (const ExitCode code = apply_bag(options, *config); code != ExitCode::ok) return to_int(code);
  if (const auto backend = gvom::services::backend_of(options.backend)) apply_backend(*backend, *config);
  if (options.odometry.empty()) options.odometry = config->odometry.source;
  if (options.odometry.empty()) {
    spdlog::error("no odometry: give --odometry URI or --odometry static");
    return to_int(ExitCode::usage);
  }
  return run(*config, options);
}
