// gvomctl: how the vehicle's processes are, and whether a vehicle's file works on this machine.
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "services/bridge/ros2/open_sink.hpp"
#include "services/bridge/settings.hpp"
#include "services/common/config_concerns.hpp"
#include "services/common/log.hpp"
#include "services/ingest/source_check.hpp"
#include "tools/common/broker_user.hpp"
#include "tools/ctl/commands.hpp"
#include "tools/ctl/vehicle.hpp"

namespace {

using namespace gvom;
using services::ExitCode;

struct Options {
  std::string config;
  std::vector<std::string> sets;
  bool json = false;
  double patience_s = 3.0;
  std::uint64_t count = 0;
  bool dry_run = false;
  bool keys = false;
  std::string bag;
  std::string metadata;
  ctl::MetricsOptions metrics;
};

void add_config(CLI::App& command, Options& options, bool positional) {
  CLI::Option* const config =
      positional ? command.add_option("CONFIG", options.config, "the vehicle's YAML file")->required()
                 : command.add_option("--config", options.config,
                                      std::string("the vehicle's YAML file, else ") + ctl::kInstalledVehicle +
                                          "; without one nothing is known to be missing");
  config->type_name("FILE");
  command.add_option("--set", options.sets, "override a key of it; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_commands(CLI::App& app, Options& options) {
  auto* const status = app.add_subcommand("status",
                                          "every process, once; exit code 0 if all is well, 1 if "
                                          "something is not, 69 without a broker");
  add_config(*status, options, false);
  status->add_flag("--json", options.json, "for scripts");
  status->add_option("--wait", options.patience_s, "seconds to listen at most")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  auto* const top = app.add_subcommand("top", "the same once a second; q or Ctrl-C ends it");
  add_config(*top, options, false);
  top->add_option("--count", options.count, "end after so many frames");
  auto* const check = app.add_subcommand("check",
                                         "does this vehicle's file work here, for this user? Exit code "
                                         "1 if there is an error, 78 if the file is wrong");
  add_config(*check, options, true);
  check->add_flag("--json", options.json, "for scripts");
  auto* const metrics = app.add_subcommand("metrics", "the same as status for Prometheus, at /metrics");
  add_config(*metrics, options, false);
  metrics->add_option("--listen", options.metrics.listen, "where")
      ->type_name("IPV4:PORT")
      ->capture_default_str();
  metrics->add_flag("--remote", options.metrics.remote, "an address that other machines reach is meant");
  auto* const reload = app.add_subcommand(
      "reload",
      "loads the vehicle's file and, if it is good, has systemd restart those whom its changes concern; one "
      "that does not load changes nothing: exit code 78");
  add_config(*reload, options, false);
  reload->add_flag("--dry-run", options.dry_run, "say who would be restarted, and end");
  reload->add_flag("--keys", options.keys, "say which key concerns whom, and end");
  auto* const bag =
      app.add_subcommand("bag",
                         "what is in a ROS 2 bag: topics, rates, clocks against each other, and the "
                         "lines of a vehicle's file that map it");
  bag->add_option("PATH", options.bag, "a folder, .db3 or .mcap")->required();
  bag->add_option("--metadata", options.metadata,
                  "write the Ousters' metadata that is in the bag there, and nothing else")
      ->type_name("FOLDER");
  app.footer(
      "Examples:\n"
      "  gvomctl status                          is all well on this vehicle?\n"
      "  gvomctl status --json | jq .problems    the same for a script\n"
      "  gvomctl check my.yaml                   will this file work here?\n"
      "  gvomctl reload --dry-run                whom does my change of the file concern?\n"
      "  gvomctl bag FOLDER                      what is in this bag, and how is it mapped?");
  app.require_subcommand(1);
}

int say_not_the_broker_user() {
  spdlog::error("cannot become the user that the broker runs as: {}", std::strerror(errno));
  return to_int(ExitCode::unavailable);
}

int say(const services::ConfigError& error) {
  std::fprintf(stderr, "%s\n", error.text().c_str());
  return to_int(ExitCode::configuration);
}

/// As every process that reads it would, the bridge too.
tl::expected<services::VehicleConfig, services::ConfigError> load(const std::string& path,
                                                                  const std::vector<std::string>& sets) {
  auto config = services::load_vehicle_config(path, sets);
  if (!config) return config;
  if (auto names = bridge::check_names(*config); !names) return tl::unexpected(names.error());
  if (auto ros2 = bridge::check_ros2(*config); !ros2) return tl::unexpected(ros2.error());
  return config;
}

/// And as its lidars' processes would: by the file alone.
tl::expected<services::VehicleConfig, services::ConfigError> load_to_run(
    const std::string& path, const std::vector<std::string>& sets) {
  auto config = load(path, sets);
  if (!config) return config;
  for (const auto& lidar : config->lidars)
    if (auto given = ingest::check_given(*config, lidar); !given) return tl::unexpected(given.error());
  return config;
}

int check(const Options& options) {
  const auto config = load(options.config, options.sets);
  return config ? ctl::show_check(*config, options.json) : say(config.error());
}

int reload(const Options& options) {
  if (options.keys) {
    std::fputs(services::concerns_table().c_str(), stdout);
    return to_int(ExitCode::ok);
  }
  services::Lifecycle lifecycle;
  const std::string path = options.config.empty() ? ctl::kInstalledVehicle : options.config;
  ctl::Units units;
  if (!tools::become_broker_user()) return say_not_the_broker_user();  // who has to be able to read the file
  const auto config = load_to_run(path, options.sets);
  if (!config) {
    std::fprintf(stderr, "%s; nothing was changed\n", config.error().text().c_str());
    return to_int(ExitCode::configuration);
  }
  return ctl::show_reload(*config, units, lifecycle, options.dry_run);
}

int watch(const std::string& command, const Options& options) {
  services::Lifecycle lifecycle;
  auto expected = ctl::expected_of(options.config, options.sets);
  ctl::Units units;
  if (!tools::become_broker_user()) return say_not_the_broker_user();
  const ctl::Watched watched{std::move(expected), ctl::surroundings_of(units), lifecycle};
  if (command == "top") return ctl::show_top(watched, options.count);
  if (command == "metrics") return ctl::serve_metrics(watched, options.metrics);
  const std::chrono::duration<double> patience(options.patience_s);
  return ctl::show_status(watched, std::chrono::duration_cast<std::chrono::milliseconds>(patience),
                          options.json);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("How the vehicle's processes are, and whether a vehicle's file works here.", "gvomctl");
  app.set_version_flag("--version", "gvomctl " GVOM_VERSION);
  add_commands(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : to_int(ExitCode::usage);  // prints help, version or the error
  }
  services::init_logging("gvomctl");
  const std::string command = app.get_subcommands().front()->get_name();
  if (command == "reload") return reload(options);
  if (command == "bag") return ctl::show_bag(options.bag, options.metadata);
  return command == "check" ? check(options) : watch(command, options);
}
