#include "tools/ctl/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/ctl/commands.hpp"

namespace gvom::ctl {

Findings check_vehicle(const services::VehicleConfig& config) {
  Findings findings = {
      {Level::ok, "configuration",
       fmt::format("{}: vehicle '{}' with {} lidar{}; relative paths begin in {}", config.path, config.name,
                   config.lidars.size(), config.lidars.size() == 1 ? "" : "s",
                   std::filesystem::current_path().string())}};
  for (const auto check : {check_memory, check_lidars, check_machine})
    for (Finding& finding : check(config)) findings.push_back(std::move(finding));
  return findings;
}

const char* to_string(Level level) {
  switch (level) {
    case Level::ok:
      return "ok";
    case Level::warning:
      return "warning";
    case Level::error:
      break;
  }
  return "error";
}

bool has_error(const Findings& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.level == Level::error; });
}

std::string to_table(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings)
    text += fmt::format("{:<9}{:<18}{}\n", to_string(finding.level), finding.what, finding.message);
  return text;
}

std::string to_json(const services::VehicleConfig& config, const Findings& findings) {
  using Json = nlohmann::ordered_json;
  Json json = {{"config", config.path},
               {"vehicle", config.name},
               {"ok", !has_error(findings)},
               {"findings", Json::array()}};
  for (const Finding& finding : findings)
    json["findings"].push_back(
        {{"level", to_string(finding.level)}, {"what", finding.what}, {"message", finding.message}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

int show_check(const services::VehicleConfig& config, bool json) {
  const Findings findings = check_vehicle(config);
  std::fputs((json ? to_json(config, findings) : to_table(findings)).c_str(), stdout);
  return has_error(findings) ? kNotWell : 0;
}

}  // namespace gvom::ctl
