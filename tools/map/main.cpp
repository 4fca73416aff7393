// gvom-map: recordings to maps in one process, without the bus. Scripts rely on what it writes.
#include <spdlog/spdlog.h>

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/common/cli.hpp"
#include "services/common/log.hpp"
#include "services/common/vehicle_config.hpp"
#include "services/ingest/loss_words.hpp"
#include "tools/map/mcap_output.hpp"
#include "tools/map/offline.hpp"
#include "tools/map/output.hpp"

namespace {

using gvom::services::ExitCode;
using gvom::services::to_int;

struct Options {
  std::vector<std::string> sources;
  std::string odometry;
  std::string out;   // empty: no folders
  std::string mcap;  // empty: no MCAP file
  bool voxels = false;
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

tl::expected<void, std::string> write_folder(gvom::tools::OfflineMapper& mapper,
                                             const gvom::tools::MappedSweep& sweep,
                                             const gvom::tools::LayerBuffers& layers,
                                             const std::string& folder, bool voxels) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return tl::unexpected(folder + ": " + error.message());
  auto written = layers.write(folder);
  if (written && voxels) written = gvom::tools::write_voxels(folder, mapper.fuser());
  return written ? gvom::tools::write_meta(folder, mapper, sweep) : written;
}

/// Where the maps go: folders of arrays, an MCAP file, or both.
class Outputs {
 public:
  Outputs(const Options& options, int size_xy) : options_(options), layers_(size_xy) {}

  tl::expected<void, std::string> open(const gvom::services::VehicleConfig& config) {
    if (options_.mcap.empty()) return {};
    auto created = gvom::tools::McapOutput::create(options_.mcap, config);
    if (!created) return tl::unexpected(created.error());
    mcap_.emplace(std::move(*created));
    return {};
  }

  tl::expected<void, std::string> write(gvom::tools::OfflineMapper& mapper,
                                        const gvom::tools::MappedSweep& sweep) {
    if (const auto made = mapper.make_layers(layers_.arrays()); !made)
      return tl::unexpected(made.error().what);
    tl::expected<void, std::string> written;
    if (!options_.out.empty())
      written = write_folder(mapper, sweep, layers_, fmt::format("{}/{:06d}", options_.out, maps_),
                             options_.voxels);
    if (written && mcap_) written = mcap_->write(layers_.arrays(), mapper.fuser());
    if (written) ++maps_;
    return written;
  }

  tl::expected<void, std::string> close() {
    return mcap_ ? mcap_->close() : tl::expected<void, std::string>{};
  }

  [[nodiscard]] int maps() const { return maps_; }

 private:
  const Options& options_;
  gvom::tools::LayerBuffers layers_;
  std::optional<gvom::tools::McapOutput> mcap_;
  int maps_ = 0;
};

/// Those that came since the last call; `told`: for each lidar, how many were said.
void say_warnings(const gvom::tools::OfflineMapper& mapper, std::vector<std::size_t>& told) {
  for (std::size_t i = 0; i < told.size(); ++i) {
    const auto& lidar = mapper.lidars()[i];
    const std::vector<std::string>& warnings = lidar.source->warnings();
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
    for (const std::string& line : lines) spdlog::warn("lidar {}: {}", lidar.name, line);
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
  std::vector<std::size_t> told(mapper->lidars().size(), 0);
  Outputs outputs(options, config.mapper.map.size_xy);
  if (const auto opened = outputs.open(config); !opened) {
    spdlog::error("{}", opened.error());
    return to_int(ExitCode::unavailable);
  }
  gvom::tools::MappedSweep sweep;
  ExitCode code = ExitCode::ok;
  for (;;) {
    say_warnings(*mapper, told);
    const auto mapped = mapper->next(sweep);
    if (!mapped) {
      spdlog::error("{}", mapped.error().what);
      code = mapped.error().code;
      if (code != ExitCode::bad_data) return to_int(code);
      continue;  // one recording broke off; the others go on
    }
    if (!*mapped) break;
    if (const auto written = outputs.write(*mapper, sweep); !written) {
      spdlog::error("{}", written.error());
      static_cast<void>(outputs.close());  // its words are those of the error
      return to_int(ExitCode::unavailable);
    }
  }
  if (const auto closed = outputs.close(); !closed) {
    spdlog::error("{}", closed.error());
    return to_int(ExitCode::unavailable);
  }
  say_losses(*mapper, config);
  say_grounds(*mapper);
  spdlog::info("{} maps in {}; {} sweeps without odometry around them, {} maps refused", outputs.maps(),
               options.out.empty() ? options.mcap : options.out, mapper->sweeps_without_odometry(),
               mapper->maps_refused());
  return to_int(outputs.maps() == 0 && code == ExitCode::ok ? ExitCode::bad_data : code);
}

}  // namespace

int main(int argc, char** argv) {
  gvom::services::init_logging("gvom-map");
  gvom::services::Cli cli("gvom-map", "Maps recordings in one process: a folder of layers after each sweep.");
  Options options;
  cli.app().add_option("--source", options.sources, "NAME=URI: the recording of one of the vehicle's lidars");
  cli.app().add_option("--odometry", options.odometry,
                       "tum:FILE, euroc:FILE, kitti:FILE?times=FILE, bag:PATH?topic=TOPIC, "
                       "bag:PATH?tf=PARENT/CHILD, or static: "
                       "the vehicle stands at the origin "
                       "(default: odometry.source)");
  cli.app().add_option("--out", options.out, "folder for the maps, 000000 and up");
  cli.app()
      .add_option("--mcap", options.mcap, "one file of the maps for Foxglove, as gvom-bridge records them")
      ->type_name("FILE.mcap");
  cli.app().add_flag("--voxels", options.voxels, "write the fused voxels too");
  cli.app().add_flag("--no-deskew", options.no_deskew,
                     "give all returns of a sweep its stamp (R3 off, for comparison)");
  cli.app()
      .add_option("--backend", options.backend,
                  "of fusion and all lidars, instead of fusion.backend and lidars.*.backend")
      ->check(CLI::IsMember(std::set<std::string>{"auto", "cpu", "cuda"}));
  cli.app().footer(
      "Example:\n  gvom-map --config vehicle.yaml --source top=scans:FOLDER --odometry tum:odometry.tum "
      "--out maps --voxels");
  auto config = cli.parse(argc, argv);
  if (!config) return to_int(config.error());
  if (options.out.empty() && options.mcap.empty()) {
    spdlog::error("--out DIR or --mcap FILE is missing");
    return to_int(ExitCode::usage);
  }
  if (const ExitCode code = apply_sources(options.sources, *config); code != ExitCode::ok)
    return to_int(code);
  if (const auto backend = gvom::services::backend_of(options.backend)) apply_backend(*backend, *config);
  if (options.odometry.empty()) options.odometry = config->odometry.source;
  if (options.odometry.empty()) {
    spdlog::error("no odometry: give --odometry URI or --odometry static");
    return to_int(ExitCode::usage);
  }
  return run(*config, options);
}
