// A vehicle of two lidars at which all is well, for a test to break.
#pragma once

#include <map>
#include <string>

#include "tests/ctl/messages.hpp"
#include "tools/ctl/snapshot.hpp"

namespace gvom::test {

inline constexpr std::int64_t kNow_ns = 1000 * kSecond_ns;

struct VehicleAt {
  VehicleAt() {
    for (const std::int64_t before_ns : {kSecond_ns + kSecond_ns / 2, kSecond_ns / 2}) {
      const auto counter = static_cast<std::uint64_t>(100 - before_ns * 10 / kSecond_ns);  // 85, 95
      for (const std::string& process : expected.processes)
        observed.add(health_of(process.c_str(), ipc::HealthState::ok, kNow_ns - before_ns,
                               {{"sweeps_in", counter}, {"drop_overrun", counter}, {"drop_no_chunk", 0}}));
    }
    observed.add(layers_at(kNow_ns - 50'000'000));
    ipc::MessageHeader odometry{};
    for (int i = 0; i <= 20; ++i) {
      odometry.sequence = static_cast<std::uint64_t>(i + 1);
      observed.add(odometry, kNow_ns - kSecond_ns + i * kSecond_ns / 20);
    }
    observed.add(std::vector<ipc::PoolUse>{{1000, 100, 7, 90}, {2000, 10, 3, 2}});
  }

  [[nodiscard]] ctl::Snapshot snapshot() const {
    const ctl::Surroundings surroundings = {
        [this](std::uint32_t pid) { return pid == ended_pid ? std::nullopt : std::optional(usage); },
        [this](const std::string& process) {
          const auto found = restarts.find(process);
          return found == restarts.end() ? std::nullopt : std::optional(found->second);
        },
        [this](const std::string& process) { return process == stopped ? why_stopped : ""; }};
    return ctl::assess(broker, observed, expected, surroundings, {kNow_ns});
  }

  ctl::Expected expected{"two_lidars",
                         {"gvom-odometry", "gvom-fusion", "gvom-ingest-front", "gvom-ingest-rear"},
                         kVersion,
                         {},
                         kConfigHash};
  ctl::Broker broker{ctl::BrokerState::up, true, 3, ""};
  ctl::Observed observed;
  tools::Usage usage{1.5, 2'000'000'000, 50'000'000};
  std::map<std::string, std::uint64_t> restarts{{"gvom-fusion", 2}};
  std::uint32_t ended_pid = 0;
  std::string stopped;  ///< A process that systemd says something of.
  std::string why_stopped;
};

inline const ctl::ProcessView& process(const ctl::Snapshot& snapshot, const std::string& name) {
  for (const ctl::ProcessView& view : snapshot.processes)
    if (view.name == name) return view;
  throw std::out_of_range(name);
}

/// The Health of an ingest that judges the ground, in 20 sweeps on the way.
inline ipc::Health ground_of(const char* process, ipc::GroundVerdict verdict, float height_m, float slope_x) {
  ipc::Health health = health_of(process, ipc::HealthState::ok, kNow_ns);
  health.ground = {static_cast<std::uint32_t>(verdict), 20, 0, height_m, slope_x, 0, 1, 0};
  return health;
}

}  // namespace gvom::test
