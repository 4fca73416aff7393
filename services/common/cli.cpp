#include "services/common/cli.hpp"

#include <iostream>

#include "services/common/lifecycle.hpp"

namespace gvom::services {

Cli::Cli(const std::string& name, const std::string& description) : app_(description, name) {
  app_.set_version_flag("--version", name + " " + GVOM_VERSION);
  app_.add_option("--config", config_path_, "the vehicle's YAML file")->type_name("FILE")->required();
  app_.add_option("--set", sets_, "override a key of it, VALUE being YAML; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app_.add_flag("--check", check_only_, "look whether it would start, say OK or what is wrong, and end");
  app_.add_flag("--print-config", print_only_, "print the configuration with all defaults, and end");
}

tl::expected<VehicleConfig, ExitCode> Cli::parse(int argc, const char* const* argv) {
  try {
    app_.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked_for = app_.exit(error) == 0;  // prints help, version or the error
    return tl::make_unexpected(asked_for ? ExitCode::ok : ExitCode::usage);
  }
  const auto config = load();
  if (!config) {
    std::cerr << config.error().text() << "\n";
    notify_status(config.error().text().c_str());
    return tl::make_unexpected(ExitCode::configuration);
  }
  if (print_only_) print_config(*config, std::cout);
  if (check_only_ && inspect_) {
    if (const ExitCode code = inspect_(*config); code != ExitCode::ok) return tl::make_unexpected(code);
  }
  if (check_only_) std::cout << "OK\n";
  if (print_only_ || check_only_) return tl::make_unexpected(ExitCode::ok);
  return *config;
}

tl::expected<VehicleConfig, ConfigError> Cli::load() const {
  auto config = load_vehicle_config(config_path_, sets_);
  if (!config) return config;
  for (const Check& check : checks_) {
    const auto checked = check(*config);
    if (!checked) return tl::make_unexpected(checked.error());
  }
  return config;
}

}  // namespace gvom::services
