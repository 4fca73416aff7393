// The command line that all executables share:
//   --help --version --config FILE --check --print-config --set KEY=VALUE
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <tl/expected.hpp>

#include "services/common/config_file.hpp"
#include "services/common/exit_code.hpp"

namespace gvom::services {

/// In main:
///
///     Cli cli("gvom-ingest", "Maps the sweeps of one lidar.");
///     std::string lidar;
///     cli.app().add_option("--lidar", lidar, "which of the vehicle's lidars")->required();
///     cli.also_check([&](const auto& config) { return find_lidar(config, lidar).map([](auto) {}); });
///     const auto config = cli.parse(argc, argv);
///     if (!config) return to_int(config.error());
class Cli {
 public:
  using Check = std::function<tl::expected<void, ConfigError>(const VehicleConfig&)>;
  using Inspect = std::function<ExitCode(const VehicleConfig&)>;

  Cli(const std::string& name, const std::string& description);

  /// For options of the executable's own; add them before `parse`.
  CLI::App& app() { return app_; }

  /// A check of the configuration that only this executable can make; part of --check. Exit code 78.
  void also_check(Check check) { checks_.push_back(std::move(check)); }

  /// What --check looks at beyond the configuration, and only --check. It prints what it finds; a code other
  /// than ok ends the process, without the OK.
  void on_check(Inspect inspect) { inspect_ = std::move(inspect); }

  /// The loaded configuration, or the code to exit with because everything is said: help, version,
  /// --check or --print-config was asked for (ok), the command line (usage) or the configuration
  /// (configuration) is wrong. Prints to stdout what was asked for and to stderr what is wrong.
  tl::expected<VehicleConfig, ExitCode> parse(int argc, const char* const* argv);

 private:
  tl::expected<VehicleConfig, ConfigError> load() const;

  CLI::App app_;
  std::vector<Check> checks_;
  Inspect inspect_;
  std::string config_path_;
  std::vector<std::string> sets_;
  bool check_only_ = false;
  bool print_only_ = false;
};

}  // namespace gvom::services
