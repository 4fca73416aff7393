#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "ipc/pools.hpp"
#include "ipc/text.hpp"
#include "services/common/bus/pool_spec.hpp"
#include "services/common/config_concerns.hpp"
#include "tools/common/health_view.hpp"
#include "tools/ctl/bus_watch.hpp"
#include "tools/ctl/commands.hpp"
#include "tools/ctl/vehicle.hpp"

namespace gvom::ctl {

namespace {

using services::ExitCode;

constexpr char kRestart[] = "TryRestartUnit";
constexpr std::chrono::milliseconds kStep{50};
constexpr std::chrono::seconds kPatience{3};
// A Health comes once a second, and who runs without being asked for is heard by then.
constexpr std::chrono::milliseconds kLeast{1500};

struct Step {
  const char* method;
  std::string unit;
  std::string why;
};

bool are_all_heard(const BusWatch& watch, const Expected& expected) {
  return !watch.observed().pools().empty() &&
         std::all_of(expected.processes.begin(), expected.processes.end(),
                     [&](const auto& name) { return watch.observed().find(name) != nullptr; });
}

void listen(BusWatch& watch, const Expected& expected, const services::Lifecycle& lifecycle) {
  const auto begun = std::chrono::steady_clock::now();
  std::chrono::steady_clock::duration passed;
  do {
    watch.step(kStep);
    passed = std::chrono::steady_clock::now() - begun;
  } while (watch.broker().state == BrokerState::up && !lifecycle.stopping() &&
           (passed < kLeast || (!are_all_heard(watch, expected) && passed < kPatience)));
}

/// Why everything has to start again; empty if not.
std::string why_all(const BusWatch& watch, const ipc::PoolPlan& plan) {
  if (watch.broker().state != BrokerState::up) return "no broker answers";
  if (watch.observed().pools().empty()) return "the broker does not tell its pools";
  return has_other_pools(watch.observed().pools(), plan.pools) ? "the pools of shared memory change" : "";
}

/// What to do with a process that was heard; its method is null if nothing.
Step step_of(const ipc::Health& health, const Expected& expected) {
  const std::string process(ipc::text_of(health.process));
  const auto hash = expected.process_hashes.find(process);
  if (hash == expected.process_hashes.end() && !tools::lidar_of(process).empty())
    return {"StopUnit", unit_of(process), "the file has no such lidar; systemctl disable it"};
  if (hash == expected.process_hashes.end()) return {nullptr, "", ""};
  if (ipc::text_of(health.version) != expected.version)
    return {kRestart, unit_of(process), fmt::format("it is of gvom {}", ipc::text_of(health.version))};
  if (health.config_hash != hash->second)
    return {kRestart, unit_of(process), "keys that concern it have changed"};
  return {nullptr, "", ""};
}

std::vector<Step> steps_of(const BusWatch& watch, const Expected& expected, const std::string& all_because,
                           Units& units) {
  std::vector<Step> steps;
  for (const HeardProcess& heard : watch.observed().processes()) {
    const Step step = step_of(heard.newest, expected);
    if (step.method != nullptr) steps.push_back(step);
  }
  const auto has = [&](const std::string& unit) {
    return std::any_of(steps.begin(), steps.end(), [&](const Step& step) { return step.unit == unit; });
  };
  for (const std::string& process : expected.processes) {
    const auto state = units.state(process);
    if (state && state->active == "failed")
      steps.push_back(
          {"StartUnit", state->unit, "it had failed" + (state->status.empty() ? "" : ": " + state->status)});
    else if (state && state->active == "inactive")
      std::printf("%s: is not started: %s\n", process.c_str(), why_not_running(*state).c_str());
    else if (!all_because.empty() && !has(unit_of(process)))
      steps.push_back({kRestart, unit_of(process), all_because});
  }
  for (const char* process : kByChoice) {
    const auto state = watch.observed().find(process) == nullptr ? units.state(process) : std::nullopt;
    if (state && state->active == "failed")
      steps.push_back({"StartUnit", state->unit, "it had failed"});
    else if (state && state->active != "inactive")
      steps.push_back({kRestart, state->unit, "it runs, and was not heard"});
  }
  const auto broker = units.state("gvom-roudi");
  const bool failed = broker && broker->active == "failed";
  if (!all_because.empty())
    steps.push_back({failed ? "StartUnit" : kRestart, "gvom-roudi.service", all_because});
  if (!steps.empty()) steps.push_back({kRestart, "gvom-metrics.service", "it goes by the same file"});
  return steps;
}

const char* words_of(const Step& step) {
  if (std::string(step.method) == kRestart) return "is restarted if it runs";
  return std::string(step.method) == "StopUnit" ? "is stopped" : "is started";
}

}  // namespace

int show_reload(const services::VehicleConfig& config, Units& units, const services::Lifecycle& lifecycle,
                bool dry_run) {
  const auto plan = ipc::plan_pools(services::pool_spec(config));
  if (!plan) {
    std::fprintf(stderr, "%s: %s; nothing was changed\n", config.path.c_str(), plan.error().message.c_str());
    return to_int(ExitCode::configuration);
  }
  if (!units.is_open()) {
    std::fprintf(stderr, "%s loads, but no systemd that runs gvom answers: nothing was changed\n",
                 config.path.c_str());
    return to_int(ExitCode::unavailable);
  }
  const Expected expected = expected_of(config);
  std::vector<Step> steps;
  {
    BusWatch watch;
    listen(watch, expected, lifecycle);
    steps = steps_of(watch, expected, why_all(watch, *plan), units);
  }
  for (const Step& step : steps)
    std::printf("%s: %s: %s\n", step.unit.c_str(), words_of(step), step.why.c_str());
  if (steps.empty()) std::printf("%s: nobody who runs is concerned\n", config.path.c_str());
  std::fflush(stdout);
  int code = 0;
  for (const Step& step : steps) {
    const auto refused = dry_run ? std::nullopt : units.order(step.method, step.unit);
    if (!refused || step.unit == "gvom-metrics.service") continue;
    std::fprintf(stderr, "%s: %s\n", step.unit.c_str(), refused->c_str());
    code = to_int(ExitCode::unavailable);
  }
  return code;
}

}  // namespace gvom::ctl
