// gvom-snapshot: layers as pictures that a person understands, from the bus (as a planner would take them) or
// from a folder that gvom-map wrote.
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <string_view>
#include <thread>

#include "services/common/cli.hpp"
#include "services/common/log.hpp"
#include "tools/common/broker_user.hpp"
#include "tools/snapshot/consumer.hpp"
#include "tools/snapshot/folder.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

struct LiveOptions {
  snapshot::OutputOptions output;
  std::string name = "gvom-snapshot";
  double every_s = 0.0;
  double timeout_s = 10.0;
  bool once = false;
  bool final = false;
};

void add_options(CLI::App& app, LiveOptions& options) {
  auto& output = options.output;
  app.add_option("--out", output.folder, "where the pictures go")->type_name("DIR")->required();
  auto* every = app.add_option("--every", options.every_s,
                               "a picture at this interval, numbered montages, and the newest at SIGTERM")
                    ->type_name("S")
                    ->check(CLI::Range(0.05, 3600.0));
  auto* final = app.add_flag("--final", options.final, "wait for SIGTERM, then write the newest layers");
  auto* once = app.add_flag("--once", options.once, "write the first layers and end (the default)");
  once->excludes(every)->excludes(final);
  final->excludes(every);
  app.add_flag("--npy", output.npy, "the arrays too, as gvom-map writes them, in DIR/NNNNNN/");
  app.add_option("--timeout", options.timeout_s,
                 "wait at most so long for the broker, and with --once for the layers")
      ->type_name("S")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("--name", options.name, "of this process on the bus, if several run")->capture_default_str();
  app.add_option("--from",
                 "draw this folder of gvom-map's instead; alone or with --out (default: the folder)")
      ->type_name("DIR");
}

std::chrono::milliseconds to_milliseconds(double time_s) {
  return std::chrono::milliseconds(std::llround(time_s * 1e3));
}

/// As PlannerClient::connect, but a stop cuts the wait short.
ipc::Expected<ipc::PlannerClient> connect(const LiveOptions& options, const services::Lifecycle& lifecycle) {
  constexpr std::chrono::milliseconds kSlice{200};
  const auto deadline = std::chrono::steady_clock::now() + to_milliseconds(options.timeout_s);
  while (true) {
    auto client = ipc::PlannerClient::connect(options.name, kSlice);
    const bool wait = !client && client.error().kind == ipc::ErrorKind::unavailable;
    if (!wait || lifecycle.stopping() || std::chrono::steady_clock::now() > deadline) return client;
  }
}

ExitCode run_live(int argc, char** argv) {
  services::Lifecycle lifecycle;
  LiveOptions options;
  services::Cli cli("gvom-snapshot", "Draws the layers on the bus: a montage and a picture of each.");
  add_options(cli.app(), options);
  cli.app().footer("Example:\n  gvom-snapshot --config vehicle.yaml --out pictures --every 2");
  const auto config = cli.parse(argc, argv);
  if (!config) return config.error();
  services::init_logging("gvom-snapshot");

  if (!tools::become_broker_user()) {
    spdlog::error("cannot become the user that the broker runs as: {}", std::strerror(errno));
    return ExitCode::unavailable;
  }
  options.output.numbered = options.every_s > 0;
  auto output = snapshot::Output::open(options.output);
  if (!output) {
    spdlog::error("{}", output.error());
    return ExitCode::unavailable;
  }
  auto client = connect(options, lifecycle);
  if (!client) {
    spdlog::error("{}", client.error().message);
    return client.error().kind == ipc::ErrorKind::bad_name ? ExitCode::usage : ExitCode::try_again;
  }
  snapshot::Schedule schedule;
  schedule.once = !options.final && options.every_s == 0;
  if (options.every_s > 0) schedule.every = to_milliseconds(options.every_s);
  schedule.timeout = to_milliseconds(options.timeout_s);
  const ExitCode code = snapshot::consume(*client, lifecycle, schedule, config->name, *output);
  if (!client->runtime().broker_alive())
    _exit(to_int(code));  // destructors of ports without a broker can hang
  return code;
}

ExitCode run_offline(int argc, char** argv) {
  CLI::App app("Draws the layers of a folder that gvom-map wrote.", "gvom-snapshot");
  std::string folder;
  snapshot::OutputOptions options;
  app.add_option("--from", folder, "folder with meta.json and .npy")->type_name("DIR")->required();
  app.add_option("--out", options.folder, "where the pictures go (default: the same folder)")
      ->type_name("DIR");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::ok : ExitCode::usage;
  }
  if (options.folder.empty()) options.folder = folder;

  const auto layers = snapshot::read_folder(folder);
  if (!layers) {
    std::cerr << "gvom-snapshot: " << layers.error() << "\n";
    return ExitCode::bad_data;
  }
  auto output = snapshot::Output::open(options);
  const auto written = output ? output->write(layers->picture) : tl::make_unexpected(output.error());
  if (!written) {
    std::cerr << "gvom-snapshot: " << written.error() << "\n";
    return ExitCode::unavailable;
  }
  std::cout << "pictures in " << output->folder() << "\n";
  return ExitCode::ok;
}

}  // namespace

int main(int argc, char** argv) {
  const bool offline = std::any_of(argv + 1, argv + argc, [](const char* argument) {
    return std::string_view(argument).substr(0, 6) == "--from";
  });
  return to_int(offline ? run_offline(argc, argv) : run_live(argc, argv));
}
