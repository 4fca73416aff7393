#include <cctype>

#include "ipc/text.hpp"
#include "tools/ctl/exposition.hpp"
#include "tools/ctl/render.hpp"

namespace gvom::ctl {

namespace {

using Type = Exposition::Type;

template <typename T>
void gauge(Exposition& out, const std::string& name, const std::string& help, const Labels& labels, T value) {
  out.add(Type::gauge, name, help, labels, static_cast<double>(value));
}

template <typename T>
void gauge_if(Exposition& out, const std::string& name, const std::string& help, const Labels& labels,
              const std::optional<T>& value) {
  if (value) gauge(out, name, help, labels, *value);
}

template <typename T>
void count(Exposition& out, const std::string& name, const std::string& help, const Labels& labels, T value) {
  out.add(Type::counter, name, help, labels, static_cast<double>(value));
}

/// A counter's name as a part of a metric's.
std::string metric_part(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

void add_state(Exposition& out, const ProcessView& process, const Labels& labels) {
  gauge(out, "gvom_up", "1 if the process works: its state is ok.", labels,
        process.state == ProcessState::ok ? 1 : 0);
  for (int i = 0; i < kProcessStates; ++i) {
    Labels with_state = labels;
    with_state.emplace_back("state", to_string(static_cast<ProcessState>(i)));
    gauge(out, "gvom_state", "1 for the state that the process is in, 0 for the others.", with_state,
          process.state == static_cast<ProcessState>(i) ? 1 : 0);
  }
  gauge_if(out, "gvom_health_age_seconds", "Since the process's last Health.", labels, process.health_age_s);
  gauge_if(out, "gvom_data_age_seconds",
           "Fusion: of the packets in its newest layers; a lidar: of its newest map in them.", labels,
           process.data_age_s);
  gauge_if(out, "gvom_product_rate_hertz", "Maps, layers or odometry messages made over the last second.",
           labels, process.rate_hz);
  if (process.restarts)
    count(out, "gvom_restarts_total", "Restarts by systemd since the unit was started by hand.", labels,
          *process.restarts);
  if (!process.version.empty()) {
    Labels build = labels;
    build.emplace_back("version", process.version);
    build.emplace_back("config", process.config_hash);
    gauge(out, "gvom_build_info", "What runs: gvom's version, and the hash of the configuration.", build, 1);
  }
  if (process.backend.empty()) return;
  Labels backend = labels;
  backend.emplace_back("backend", process.backend);
  backend.emplace_back("details", process.backend_details);
  gauge(out, "gvom_backend_info", "What computes, and on what.", backend, 1);
}

void add_ground(Exposition& out, const GroundView& ground, const Labels& labels) {
  gauge(out, "gvom_ground_judged", "1 if the lidar saw enough ground to judge T_base_sensor by.", labels,
        ground.verdict == ipc::GroundVerdict::not_judged ? 0 : 1);
  gauge(out, "gvom_ground_wrong", "1 if the ground is not where the vehicle's file puts it.", labels,
        ground.verdict == ipc::GroundVerdict::wrong ? 1 : 0);
  if (ground.sweeps == 0) return;
  gauge(out, "gvom_ground_height_metres", "The ground above where the vehicle's file puts it.", labels,
        ground.height_m);
  gauge(out, "gvom_ground_slope_x", "Of the ground in base_link, metres per metre ahead.", labels,
        ground.slope_x);
  gauge(out, "gvom_ground_slope_y", "Of the ground in base_link, metres per metre to the left.", labels,
        ground.slope_y);
}

void add_usage(Exposition& out, const tools::Usage& usage, const Labels& labels) {
  gauge(out, "gvom_process_memory_bytes", "Memory of the process's own, without shared memory.", labels,
        usage.private_bytes);
  count(out, "gvom_process_cpu_seconds_total", "Processor time since the process started.", labels,
        usage.cpu_s);
}

void add_counters(Exposition& out, const ProcessView& process, const Labels& labels) {
  for (const auto& [name, value] : process.counters) {
    if (!tools::is_drop(name)) {
      count(out, "gvom_" + metric_part(name) + "_total", "Counter " + name + " of the process's Health.",
            labels, value);
      continue;
    }
    Labels with_reason = labels;
    with_reason.emplace_back("reason", name.compare(0, 5, "drop_") == 0 ? name.substr(5) : name);
    count(out, "gvom_drops_total", "What was dropped or lost since the process started, by reason.",
          with_reason, value);
  }
  for (const ipc::Health::Stage& stage : process.stages) {
    const std::pair<const char*, double> statistics[] = {
        {"p50", stage.p50_ms}, {"p99", stage.p99_ms}, {"max", stage.max_ms}};
    for (const auto& [statistic, value_ms] : statistics) {
      Labels with_stage = labels;
      with_stage.emplace_back("stage", ipc::text_of(stage.name));
      with_stage.emplace_back("statistic", statistic);
      gauge(out, "gvom_stage_seconds", "Time of a stage over the last second.", with_stage, value_ms * 1e-3);
    }
  }
}

void add_layers(Exposition& out, const LayersView& layers) {
  gauge(out, "gvom_layers_age_seconds", "Since the newest packet in the layers was received.", {},
        layers.age_s);
  gauge(out, "gvom_layers_publish_age_seconds", "Since the newest layers were published.", {},
        layers.publish_age_s);
  gauge(out, "gvom_layers_maps_in_window", "Maps that the layers are made of.", {}, layers.maps_in_window);
  for (const LidarView& lidar : layers.lidars) {
    const Labels labels = {{"lidar", lidar.name}};
    gauge(out, "gvom_lidar_missing", "1 if the layers are without this lidar.", labels,
          lidar.missing ? 1 : 0);
    gauge(out, "gvom_lidar_unknown",
          "1 if the lidar publishes maps, but fusion's configuration does not have it.", labels,
          lidar.unknown ? 1 : 0);
    gauge(out, "gvom_lidar_columns_seen_ratio", "Of the columns of its newest sweep; 1: complete.", labels,
          lidar.columns_seen_fraction);
    gauge(out, "gvom_lidar_maps_in_window", "Maps of this lidar that the layers are made of.", labels,
          lidar.maps_in_window);
    count(out, "gvom_lidar_maps_lost_total", "Maps of this lidar that fusion never got.", labels,
          lidar.maps_lost);
  }
}

void add_pools(Exposition& out, const std::vector<ipc::PoolUse>& pools) {
  for (const ipc::PoolUse& pool : pools) {
    const Labels labels = {{"chunk_bytes", std::to_string(pool.chunk_bytes)}};
    gauge(out, "gvom_pool_chunks", "Chunks of this pool of shared memory.", labels, pool.chunks);
    gauge(out, "gvom_pool_used_chunks", "Chunks in use.", labels, pool.used);
    gauge(out, "gvom_pool_fewest_free_chunks", "The fewest that were free since the broker started.", labels,
          pool.min_free);
  }
}

}  // namespace

std::string to_prometheus(const Snapshot& snapshot) {
  Exposition out;
  gauge(out, "gvom_problems", "How many things are not as they should be; 0: all is well.", {},
        snapshot.problems.size());
  for (const ProcessView& process : snapshot.processes) {
    const Labels labels = {{"process", process.name}};
    add_state(out, process, labels);
    if (process.ground) add_ground(out, *process.ground, labels);
    if (process.usage) add_usage(out, *process.usage, labels);
    add_counters(out, process, labels);
  }
  if (snapshot.layers) add_layers(out, *snapshot.layers);
  if (snapshot.odometry) {
    gauge(out, "gvom_odometry_age_seconds", "Since the last odometry was heard.", {},
          snapshot.odometry->age_s);
    gauge_if(out, "gvom_odometry_rate_hertz", "Odometry messages a second.", {}, snapshot.odometry->rate_hz);
  }
  add_pools(out, snapshot.pools);
  return out.text();
}

}  // namespace gvom::ctl
