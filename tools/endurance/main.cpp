// gvom-soak: the whole graph under live packets for as long as asked for, and a verdict on it. tools/soak
// runs it.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "services/common/config_file.hpp"
#include "services/common/source_uri.hpp"
#include "tools/endurance/soak.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

constexpr int kBadVerdict = 1;

struct Options {
  std::string config;
  std::string recording;
  std::string programs;
  bool units = false;
  endurance::SoakOptions soak;
};

void add_options(CLI::App& app, Options& options) {
  app.add_option("--config", options.config, "the vehicle's YAML file, with ouster-udp sources")->required();
  app.add_option("--recording", options.recording, "folder of gvom-sim's output for that vehicle")
      ->required();
  app.add_option("--out", options.soak.out, "folder for samples, logs and verdict.json")->required();
  app.add_option("--minutes", options.soak.minutes, "how long")->check(CLI::Range(0.1, 100000.0));
  auto* const programs =
      app.add_option("--programs", options.programs, "folder of the programs, which are kept running");
  app.add_flag("--units", options.units, "systemd keeps them running")->excludes(programs);
  app.add_flag("--faults", options.soak.faults, "make faults at random moments");
  app.add_option("--fault-every", options.soak.fault_every_s, "seconds between faults, in the mean")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  app.add_option("--recovery", options.soak.recovery_s, "seconds after a fault until all must be well again")
      ->check(CLI::Range(1.0, 60.0))
      ->capture_default_str();
  app.add_option("--seed", options.soak.seed, "of the faults")->capture_default_str();
}

int fail(const std::string& message, ExitCode code) {
  std::fprintf(stderr, "gvom-soak: %s\n", message.c_str());
  return to_int(code);
}

tl::expected<std::uint16_t, std::string> port_of(const services::LidarConfig& lidar) {
  return services::parse_source_uri(lidar.source)
      .and_then([](const auto& uri) { return services::parse_port(uri.path); })
      .map_error([&](const std::string& error) {
        return "lidar " + lidar.name + ": its source is no UDP port: " + error;
      });
}

int soak(Options& options) {
  const auto config = services::load_vehicle_config(options.config, {});
  if (!config) return fail(config.error().text(), ExitCode::configuration);
  for (const services::LidarConfig& lidar : config->lidars) {
    const auto port = port_of(lidar);
    if (!port) return fail(port.error(), ExitCode::configuration);
    options.soak.lidars.push_back(lidar.name);
    options.soak.ports.push_back(*port);
  }
  auto recording = endurance::read_recording(options.recording, options.soak.lidars);
  if (!recording) return fail(recording.error(), ExitCode::bad_data);
  endurance::Board* const board = endurance::make_board();
  if (board == nullptr) return fail("no memory to share", ExitCode::unavailable);

  services::Lifecycle lifecycle;
  std::optional<endurance::Supervisor> supervisor;
  if (!options.units)
    supervisor.emplace(endurance::Supervisor::Place{options.programs, options.recording, options.soak.out},
                       std::vector<std::string>{"--config", options.config}, options.soak.lidars);
  endurance::Soak soak(options.soak, *recording, *board, supervisor ? &*supervisor : nullptr, lifecycle);
  recording = {};  // the process that sends it has its own
  ::malloc_trim(0);
  const ExitCode ran = soak.run();
  if (supervisor) supervisor->stop();
  if (ran != ExitCode::ok) return to_int(ran);
  return soak.write_verdict() ? 0 : kBadVerdict;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Runs the whole graph under live packets, and judges it. tools/soak prepares what it needs.",
               "gvom-soak");
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : to_int(ExitCode::usage);
  }
  if (options.units == !options.programs.empty())
    return fail("either --programs or --units", ExitCode::usage);
  for (std::string* const path : {&options.config, &options.recording, &options.soak.out, &options.programs})
    if (!path->empty()) *path = std::filesystem::absolute(*path).string();
  return soak(options);
}
