// gvom-drive: the reference planner drives a simulated vehicle, in lock-step.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <mutex>
#include <optional>
#include <sstream>

#include "services/common/config_file.hpp"
#include "services/common/exit_code.hpp"
#include "services/common/log.hpp"
#include "tools/drive/cli/campaign.hpp"
#include "tools/drive/cli/course_run.hpp"
#include "tools/drive/cli/table.hpp"
#include "tools/drive/live/run_live.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

int fail(ExitCode code, const std::string& message) {
  std::fprintf(stderr, "gvom-drive: %s\n", message.c_str());
  return to_int(code);
}

/// The options that a drive depends on, as a command has them.
std::string command_of(const std::string& vehicle, const std::vector<std::string>& sets,
                       const driving::CampaignOptions& options) {
  std::ostringstream out;
  out << "--config " << vehicle;
  for (const std::string& set : sets) out << " --set " << set;
  if (!options.course.empty()) out << " --course " << options.course;
  if (!options.folder_of_world.empty()) out << " --world " << options.folder_of_world;
  out << " --length " << options.length_m << " --sensor " << sim::name_of(options.sensor) << " --noise "
      << options.noise[0] << " " << options.noise[1] << " --ablation " << driving::name_of(options.ablation);
  return out.str();
}

int drive_all(const services::VehicleConfig& config, driving::CampaignOptions options,
              const std::string& rows_path, const driving::Making& making) {
  std::optional<driving::RowsFile> file;
  if (!rows_path.empty()) {
    auto opened = driving::RowsFile::open(rows_path, making);
    if (!opened) return fail(ExitCode::usage, opened.error());
    file = std::move(*opened);
    options.driven = file->seeds();
  }
  bool written = true;
  const auto rows = driving::run_campaign(config, options, [&](const driving::Row& row) {
    std::fprintf(stderr, "%s\n", driving::line_of(row).c_str());
    if (file) written = file->append(driving::figures_of(row.world, row.seed, row.result));
  });
  if (!rows) return fail(ExitCode::unavailable, rows.error());
  if (!written) return fail(ExitCode::unavailable, rows_path + ": rows are missing, it could not be written");
  if (!file) return std::fputs(driving::table_of(*rows).c_str(), stdout), 0;
  std::fputs(driving::text_of(driving::summary_of(file->figures())).c_str(), stdout);
  return 0;
}

int drive_course(const services::VehicleConfig& config, const driving::CampaignOptions& options) {
  const auto run = driving::run_course(config, options);
  if (!run) return fail(ExitCode::unavailable, run.error());
  std::fputs(driving::text_of(*run).c_str(), stdout);
  return run->row.result.outcome == driving::Outcome::arrived ? 0 : 1;
}

/// The first seed's world through the processes on the bus. 0: the vehicle arrived.
int drive_live(const services::VehicleConfig& config, const driving::CampaignOptions& options,
               services::Lifecycle& lifecycle) {
  const std::uint64_t seed = options.first_seed;
  const auto world = driving::world_of(options, seed);
  if (!world) return fail(ExitCode::usage, world.error());
  services::init_logging("gvom-drive");
  driving::Witness witness(options.keeping, *world, seed, config);
  auto result = driving::run_live(*world, config, driving::session_options(options, seed),
                                  options.keeping.folder, lifecycle, witness.onlooker());
  if (!result) return to_int(result.error());
  const bool arrived = result->session.outcome == driving::Outcome::arrived;
  const driving::Row row{world->name, seed, std::move(result->session)};
  if (const auto drawn = witness.finish(row.result.outcome, driving::story_of(row)); !drawn)
    return fail(ExitCode::unavailable, drawn.error());
  std::printf("%s\n%s\n", driving::line_of(row).c_str(), result->figures.c_str());
  std::fflush(stdout);
  ::_exit(arrived ? 0 : 1);  // destructors of ports without a broker can hang
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Drives a simulated vehicle by the reference planner, in lock-step: simulated sweeps are mapped "
      "and fused, the planner plans, the vehicle moves."};
  driving::CampaignOptions options;
  std::string vehicle, seeds = "1", sensor, ablation = "none", rows_path, strips = "failed";
  std::vector<std::string> sets;
  bool live = false, figures = false;
  app.add_option("--config", vehicle, "the vehicle's file")->required();
  app.add_option("--set", sets, "overrides a key of it: KEY=VALUE");
  app.add_option("--seeds", seeds, "of random worlds: N, or FIRST..LAST")->capture_default_str();
  auto* course = app.add_option("--course", options.course,
                                "test-1 .. test-4, the paper's tests, instead of random worlds");
  app.add_option("--length", options.length_m, "of random worlds, metres")
      ->check(CLI::Range(40.0, 1000.0))
      ->capture_default_str();
  app.add_option(
         "--world", options.folder_of_world,
         "DIR with ground.npy, surface.npy and objects.json, as gvom-sim has them; its path is driven")
      ->check(CLI::ExistingDirectory);
  app.add_option("--sensor", sensor, "that all lidars are: os1-64, os1-128; else by the vehicle's file");
  app.add_option("--ablation", ablation,
                 "takes something from the map: deskew-off, memory-off, one-lidar, paper-R9, paper-R13");
  app.add_option("--noise", options.noise, "of the odometry: metres, radians")->expected(2);
  app.add_option("--threads", options.threads, "worlds at a time; they change no byte")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--rows", rows_path,
                 "adds a row for each drive to this file as it ends, and drives no world that is in it");
  auto* out = app.add_option("--out", options.keeping.folder, "logs and pictures go there");
  app.add_option("--strip", strips, "of which drives OUT/WORLD-SEED.png is left: none, failed, all")
      ->capture_default_str();
  app.add_flag("--mcap", options.keeping.mcap,
               "leaves OUT/WORLD-SEED.mcap, too: maps, plans and poses, for Foxglove")
      ->needs(out);
  app.add_flag("--figures", figures,
               "of the course: pictures and numbers, the driven way against the waypoints'")
      ->needs(out)
      ->needs(course);
  app.add_flag(
         "--real-time", live,
         "one world, through the real processes: sends packets to the lidars' ports, odometry and a course "
         "over the bus, drives as gvom-planner commands; lidars' metadata are in OUT/NAME.json")
      ->needs(out);
  CLI11_PARSE(app, argc, argv);

  auto config = services::load_vehicle_config(vehicle, sets);
  if (!config) return fail(ExitCode::configuration, config.error().text());
  const tl::expected<sim::Sensor, std::string> found =
      sensor.empty() ? driving::sensor_of(*config) : sim::find_sensor(sensor);
  if (!found) return fail(ExitCode::usage, found.error());
  options.sensor = *found;
  const auto taken = driving::find_ablation(ablation);
  if (!taken) return fail(ExitCode::usage, taken.error());
  options.ablation = *taken;
  const auto wanted = driving::find_strips(strips);
  if (!wanted) return fail(ExitCode::usage, "--strip " + wanted.error());
  options.keeping.strips = *wanted;
  if (!driving::read_seeds(seeds, options))
    return fail(ExitCode::usage, "--seeds: expected N or FIRST..LAST");
  if (live && (figures || !rows_path.empty() || options.ablation != driving::Ablation::none))
    return fail(ExitCode::usage, "--real-time drives one world as it is: no --figures, --rows or --ablation");
  if (figures) return drive_course(*config, options);
  if (live) {
    services::Lifecycle lifecycle;  // in lock-step a signal ends it at once
    return drive_live(*config, options, lifecycle);
  }
  const driving::Making making{command_of(vehicle, sets, options), driving::hash_of_file(vehicle)};
  return drive_all(*config, options, rows_path, making);
}
