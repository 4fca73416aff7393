#include "tools/ctl/snapshot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "ipc/text.hpp"

namespace gvom::ctl {

namespace {

constexpr char kFusion[] = "gvom-fusion";
constexpr double kSilent_s = 3.0;  // a Health comes once a second

double seconds_since(std::int64_t then_ns, std::int64_t now_ns) {
  return std::max(0.0, static_cast<double>(now_ns - then_ns) * 1e-9);
}

std::vector<Drop> drops_of(const HeardProcess& heard) {
  std::vector<Drop> drops;
  const tools::Counters now = tools::counters_of(heard.newest);
  const tools::Counters before = heard.before ? tools::counters_of(*heard.before) : tools::Counters();
  const double elapsed_s =
      heard.before ? static_cast<double>(heard.newest.mono_ns - heard.before->mono_ns) * 1e-9 : 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto& [name, count] = now[i];
    if (!tools::is_drop(name) || count == 0) continue;
    const bool prefixed = name.compare(0, 5, "drop_") == 0;
    Drop drop{prefixed ? name.substr(5) : name, count, std::nullopt};
    if (elapsed_s > 0 && i < before.size() && before[i].first == name && before[i].second <= count)
      drop.per_s = static_cast<double>(count - before[i].second) / elapsed_s;
    drops.push_back(std::move(drop));
  }
  return drops;
}

ProcessState state_of(const ipc::Health& health) {
  switch (static_cast<ipc::HealthState>(health.state)) {
    case ipc::HealthState::starting:
      return ProcessState::starting;
    case ipc::HealthState::ok:
      return ProcessState::ok;
    case ipc::HealthState::degraded:
      return ProcessState::degraded;
    case ipc::HealthState::failed:
      return ProcessState::failed;
    case ipc::HealthState::stopping:
      return ProcessState::stopping;
  }
  return ProcessState::failed;
}

bool is_heard(const Broker& broker) {
  return broker.state == BrokerState::up && broker.joined;
}

/// What it is, if it is not (any more) what it said.
void judge_silence(const Broker& broker, ProcessView& view) {
  if (!view.usage) {
    view.state = ProcessState::missing;
    view.reason = fmt::format("process {} has ended, heard {:.1f} s ago", *view.pid, *view.health_age_s);
  } else if (*view.health_age_s > kSilent_s && !is_heard(broker)) {
    view.state = ProcessState::unknown;
    view.reason = fmt::format("the bus is not heard, for {:.1f} s", *view.health_age_s);
  } else if (*view.health_age_s > kSilent_s) {
    view.state = ProcessState::silent;
    view.reason =
        fmt::format("process {} is there, but was heard {:.1f} s ago", *view.pid, *view.health_age_s);
  }
}

std::optional<GroundView> view_of(const ipc::Ground& ground) {
  const auto verdict = static_cast<ipc::GroundVerdict>(ground.verdict);
  if (verdict == ipc::GroundVerdict::none) return std::nullopt;
  return GroundView{verdict,        ground.sweeps,  ground.height_m,
                    ground.slope_x, ground.slope_y, ground.on_the_way != 0};
}

std::string hash_text(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

ProcessView view_of(const HeardProcess& heard, const Surroundings& surroundings, std::int64_t mono_ns) {
  const ipc::Health& health = heard.newest;
  ProcessView view;
  view.name = ipc::text_of(health.process);
  view.state = state_of(health);
  view.reason = ipc::text_of(health.reason);
  view.pid = health.pid;
  view.rate_hz = health.rate_hz;
  view.health_age_s = seconds_since(health.mono_ns, mono_ns);
  view.drops = drops_of(heard);
  view.counters = tools::counters_of(health);
  const auto stages = std::min<std::uint32_t>(health.stage_count, ipc::Health::kMaxStages);
  view.stages.assign(health.stages, health.stages + stages);
  view.usage = surroundings.usage(health.pid);
  view.ground = view_of(health.ground);
  view.backend = ipc::text_of(health.backend);
  view.backend_details = ipc::text_of(health.backend_details);
  view.version = ipc::text_of(health.version);
  view.config_hash = hash_text(health.config_hash);
  return view;
}

ProcessView view_of(const Broker& broker, const Surroundings& surroundings) {
  ProcessView view;
  view.name = kBroker;
  view.pid = broker.pid;
  if (broker.pid) view.usage = surroundings.usage(*broker.pid);
  switch (broker.state) {
    case BrokerState::up:
      view.state = ProcessState::ok;
      break;
    case BrokerState::hung:
      view.state = ProcessState::hung;
      view.reason = "it takes no messages and no new processes: restart it, and all others with it";
      break;
    case BrokerState::absent:
      view.reason = broker.note;
      break;
  }
  return view;
}

/// Of the data in them.
double age_s(const ipc::Layers& layers, const ipc::Moment& now) {
  const auto age = ipc::elapsed(ipc::received_at(layers), now);
  if (age == ipc::kUnknownAge) return std::numeric_limits<double>::infinity();
  return std::chrono::duration<double>(age).count();
}

LayersView view_of(const ipc::Layers& layers, const ipc::Moment& now) {
  LayersView view{
      age_s(layers, now), seconds_since(layers.mono_published_ns, now.mono_ns), layers.maps_in_window, {}};
  const auto count = std::min<std::uint32_t>(layers.lidar_count, kMaxLidars);
  for (std::uint32_t i = 0; i < count; ++i) {
    const ipc::LidarStatus& lidar = layers.lidars[i];
    view.lidars.push_back({std::string(ipc::text_of(lidar.name)), lidar.missing != 0, lidar.maps_in_window,
                           lidar.maps_lost, lidar.columns_seen_fraction, lidar.unknown != 0});
  }
  return view;
}

/// How old the newest map of a lidar is: as old as the layers, and by as much older as its stamp is.
std::optional<double> map_age_s(const ipc::Layers& layers, const std::string& lidar, const ipc::Moment& now) {
  const auto count = std::min<std::uint32_t>(layers.lidar_count, kMaxLidars);
  for (std::uint32_t i = 0; i < count; ++i) {
    const ipc::LidarStatus& status = layers.lidars[i];
    if (ipc::text_of(status.name) != lidar || status.newest_stamp_ns == 0) continue;
    return age_s(layers, now) + seconds_since(status.newest_stamp_ns, layers.header.stamp_ns);
  }
  return std::nullopt;
}

/// Whether one that is there runs what this gvom and its file say.
void judge_build(const Expected& expected, ProcessView& view) {
  if (view.state == ProcessState::missing) return;
  view.other_version = !expected.version.empty() && view.version != expected.version;
  const auto of_process = expected.process_hashes.find(view.name);
  const auto hash =
      of_process == expected.process_hashes.end() ? expected.config_hash : std::optional(of_process->second);
  view.other_config = hash && view.config_hash != hash_text(*hash);
}

/// One that is expected and was never heard.
ProcessView never_heard(const std::string& name, const Broker& broker) {
  ProcessView view;
  view.name = name;
  view.state = is_heard(broker) ? ProcessState::missing : ProcessState::unknown;
  view.reason = is_heard(broker) ? "nothing was heard of it" : "the bus is not heard";
  return view;
}

std::vector<ProcessView> processes_of(const Broker& broker, const Observed& observed,
                                      const Expected& expected, const Surroundings& surroundings,
                                      std::int64_t mono_ns) {
  std::vector<ProcessView> views = {view_of(broker, surroundings)};
  views.front().other_config = has_other_pools(observed.pools(), expected.pools);
  const auto add_heard = [&](const HeardProcess& heard) {
    views.push_back(view_of(heard, surroundings, mono_ns));
    judge_silence(broker, views.back());
    judge_build(expected, views.back());
  };
  const auto& known = expected.processes;
  for (const std::string& name : known) {
    if (const HeardProcess* const heard = observed.find(name))
      add_heard(*heard);
    else
      views.push_back(never_heard(name, broker));
  }
  for (const char* name : kByChoice)
    if (observed.find(name) == nullptr && surroundings.has_failed && surroundings.has_failed(name))
      views.push_back(never_heard(name, broker));
  for (const HeardProcess& heard : observed.processes()) {
    const std::string name(ipc::text_of(heard.newest.process));
    const bool ended_well =
        state_of(heard.newest) == ProcessState::stopping && !surroundings.usage(heard.newest.pid);
    if (std::find(known.begin(), known.end(), name) == known.end() && !ended_well) add_heard(heard);
  }
  return views;
}

/// What the layers and systemd know of a process.
void complete(const Observed& observed, const Surroundings& surroundings, const ipc::Moment& now,
              ProcessView& view) {
  view.restarts = surroundings.restarts(view.name);
  if (view.state == ProcessState::missing && surroundings.why_not_running) {
    const std::string why = surroundings.why_not_running(view.name);
    if (!why.empty()) view.reason += (view.reason.empty() ? "" : "; ") + why;
  }
  const auto& layers = observed.layers();
  if (!layers) return;
  if (view.name == kFusion) view.data_age_s = age_s(*layers, now);
  const std::string lidar = tools::lidar_of(view.name);
  if (!lidar.empty()) view.data_age_s = map_age_s(*layers, lidar, now);
}

}  // namespace

bool has_other_pools(const std::vector<ipc::PoolUse>& there, const std::vector<ipc::Pool>& expected) {
  const auto same = [](const ipc::PoolUse& pool, const ipc::Pool& wanted) {
    return pool.chunk_bytes == wanted.chunk_bytes && pool.chunks == wanted.chunks;
  };
  if (there.empty() || expected.empty()) return false;
  return !std::equal(there.begin(), there.end(), expected.begin(), expected.end(), same);
}

double tilt_degrees(const GroundView& ground) {
  return std::atan(std::hypot(ground.slope_x, ground.slope_y)) * 180 / M_PI;
}

const char* to_string(ipc::GroundVerdict verdict) {
  switch (verdict) {
    case ipc::GroundVerdict::none:
      return "none";
    case ipc::GroundVerdict::not_judged:
      return "not judged";
    case ipc::GroundVerdict::well:
      return "well";
    case ipc::GroundVerdict::wrong:
      return "wrong";
  }
  return "none";
}

const char* to_string(ProcessState state) {
  constexpr const char* kWords[kProcessStates] = {"starting", "ok",   "degraded", "failed", "stopping",
                                                  "silent",   "hung", "missing",  "unknown"};
  return kWords[static_cast<int>(state)];
}

Snapshot assess(const Broker& broker, const Observed& observed, const Expected& expected,
                const Surroundings& surroundings, const ipc::Moment& now) {
  Snapshot snapshot;
  snapshot.vehicle = expected.vehicle;
  snapshot.config_error = expected.config_error;
  snapshot.version = expected.version;
  if (expected.config_hash) snapshot.config_hash = hash_text(*expected.config_hash);
  snapshot.broker = broker;
  snapshot.processes = processes_of(broker, observed, expected, surroundings, now.mono_ns);
  for (ProcessView& process : snapshot.processes) complete(observed, surroundings, now, process);
  if (observed.layers()) snapshot.layers = view_of(*observed.layers(), now);
  if (observed.odometry())
    snapshot.odometry =
        OdometryView{seconds_since(observed.odometry()->mono_ns, now.mono_ns), observed.odometry()->rate_hz};
  snapshot.pools = observed.pools();
  snapshot.refusals = observed.refusals();
  snapshot.problems = problems_of(snapshot);
  return snapshot;
}

bool is_complete(const Observed& observed, const Expected& expected) {
  if (expected.processes.empty()) return false;
  const bool all_twice =
      std::all_of(expected.processes.begin(), expected.processes.end(), [&](const std::string& name) {
        const HeardProcess* const heard = observed.find(name);
        return heard != nullptr && heard->before;
      });
  return all_twice && observed.layers() && !observed.pools().empty() && observed.odometry() &&
         observed.odometry()->rate_hz;
}

}  // namespace gvom::ctl
