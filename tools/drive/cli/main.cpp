// gvom-drive: the reference planner drives a simulated vehicle, in lock-step.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <mutex>

#include "services/common/config_file.hpp"
#include "services/common/exit_code.hpp"
#include "tools/drive/cli/campaign.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

int fail(ExitCode code, const std::string& message) {
  std::fprintf(stderr, "gvom-drive: %s\n", message.c_str());
  return to_int(code);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Drives a simulated vehicle by the reference planner, in lock-step: simulated sweeps are mapped "
      "and fused, the planner plans, the vehicle moves."};
  driving::CampaignOptions options;
  std::string vehicle, seeds = "1", sensor = "os1-64";
  std::vector<std::string> sets;
  app.add_option("--config", vehicle, "the vehicle's file")->required();
  app.add_option("--set", sets, "overrides a key of it: KEY=VALUE");
  app.add_option("--seeds", seeds, "of random worlds: N, or FIRST..LAST")->capture_default_str();
  app.add_option("--course", options.course, "test-1 .. test-4, the paper's tests, instead of random worlds");
  app.add_option("--length", options.length_m, "of random worlds, metres")
      ->check(CLI::Range(60.0, 1000.0))
      ->capture_default_str();
  app.add_option("--sensor", sensor, "that all lidars are: os1-64, os1-128")->capture_default_str();
  app.add_option("--noise", options.noise, "of the odometry: metres, radians")->expected(2);
  app.add_option("--threads", options.threads, "worlds at a time; they change no byte")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--out", options.folder, "logs and pictures go there");
  CLI11_PARSE(app, argc, argv);

  auto config = services::load_vehicle_config(vehicle, sets);
  if (!config) return fail(ExitCode::configuration, config.error().text());
  const auto found = sim::find_sensor(sensor);
  if (!found) return fail(ExitCode::usage, found.error());
  options.sensor = *found;
  if (!driving::read_seeds(seeds, options))
    return fail(ExitCode::usage, "--seeds: expected N or FIRST..LAST");
  const auto rows = driving::run_campaign(*config, options, [](const driving::Row& row) {
    std::fprintf(stderr, "%s\n", driving::line_of(row).c_str());
  });
  if (!rows) return fail(ExitCode::unavailable, rows.error());
  std::fputs(driving::table_of(*rows).c_str(), stdout);
  return 0;
}
