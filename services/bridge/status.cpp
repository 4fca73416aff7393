#include "services/bridge/status.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <nlohmann/json.hpp>

#include "ipc/text.hpp"
#include "ipc/topic.hpp"
#include "services/common/ros/diagnostics_message.hpp"

namespace gvom::bridge {
namespace {

using nlohmann::json;

json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

double seconds(std::int64_t duration_ns) {
  return 1e-9 * static_cast<double>(duration_ns);
}

json age_json(std::chrono::nanoseconds age) {
  return age == ipc::kUnknownAge ? json(nullptr) : json(seconds(age.count()));
}

const char* state_word(const ipc::Health& health, std::int64_t now_mono_ns) {
  if (now_mono_ns - health.mono_ns > ros::kSilent_ns) return "silent";
  constexpr const char* kWords[] = {"starting", "ok", "degraded", "failed", "stopping"};
  return health.state < std::size(kWords) ? kWords[health.state] : "unknown";
}

/// As gvomctl tells losses from other counts.
bool counts_losses(std::string_view name) {
  return name.compare(0, 5, "drop_") == 0;
}

json process_json(const ipc::Health& health, std::int64_t now_mono_ns) {
  json stages = json::object(), counters = json::object(), drops = json::object();
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(health.stage_count, ipc::Health::kMaxStages); ++i) {
    const auto& stage = health.stages[i];
    stages[std::string(ipc::text_of(stage.name))] = {
        {"p50_ms", number(stage.p50_ms)}, {"p99_ms", number(stage.p99_ms)}, {"max_ms", number(stage.max_ms)}};
  }
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(health.counter_count, ipc::Health::kMaxCounters);
       ++i) {
    const std::string name(ipc::text_of(health.counters[i].name));
    (counts_losses(name) ? drops : counters)[name] = health.counters[i].value;
  }
  return {{"name", ipc::text_of(health.process)},
          {"state", state_word(health, now_mono_ns)},
          {"reason", ipc::text_of(health.reason)},
          {"version", ipc::text_of(health.version)},
          {"backend", ipc::text_of(health.backend)},
          {"rate_hz", number(health.rate_hz)},
          {"heard_s", seconds(now_mono_ns - health.mono_ns)},
          {"stages", stages},
          {"counters", counters},
          {"drops", drops}};
}

/// A lidar's data is as much older than the layers as its newest stamp is than the newest of all.
json lidar_json(const ipc::Layers& layers, const ipc::LidarStatus& lidar, std::chrono::nanoseconds age) {
  std::int64_t newest_ns = 0;
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(layers.lidar_count, kMaxLidars); ++i)
    newest_ns = std::max(newest_ns, layers.lidars[i].newest_stamp_ns);
  const bool has_age = lidar.newest_stamp_ns != 0 && age != ipc::kUnknownAge;
  const double age_s = seconds(age.count()) + seconds(newest_ns) - seconds(lidar.newest_stamp_ns);
  return {{"name", ipc::text_of(lidar.name)},
          {"missing", lidar.missing != 0},
          {"unknown", lidar.unknown != 0},
          {"age_s", has_age ? json(age_s) : json(nullptr)},
          {"columns_seen_fraction", number(static_cast<double>(lidar.columns_seen_fraction))},
          {"maps_in_window", lidar.maps_in_window},
          {"maps_received", lidar.maps_received},
          {"maps_lost", lidar.maps_lost}};
}

json lidars_json(const std::optional<ipc::Layers>& layers, const ipc::Moment& now) {
  json list = json::array();
  if (!layers) return list;
  const auto age = ipc::elapsed(ipc::received_at(*layers), now);
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(layers->lidar_count, kMaxLidars); ++i)
    list.push_back(lidar_json(*layers, layers->lidars[i], age));
  return list;
}

json layers_json(const std::optional<ipc::Layers>& layers, const ipc::Moment& now) {
  if (!layers) return nullptr;
  return {{"age_s", age_json(ipc::elapsed(ipc::received_at(*layers), now))},
          {"publish_age_s", seconds(now.mono_ns - layers->mono_published_ns)},
          {"maps_in_window", layers->maps_in_window},
          {"stamp_ns", layers->header.stamp_ns}};
}

}  // namespace

std::string status_json(const Heard& heard, const ipc::Moment& now) {
  json processes = json::array();
  for (const ipc::Health& health : heard.processes) processes.push_back(process_json(health, now.mono_ns));
  json odometry = nullptr;
  if (heard.odometry)
    odometry = {{"age_s", seconds(now.mono_ns - heard.odometry_mono_ns)},
                {"stamp_ns", heard.odometry->header.stamp_ns}};
  return json{{"vehicle", heard.vehicle},
              {"version", ipc::release()},
              {"layers", layers_json(heard.layers, now)},
              {"odometry", odometry},
              {"lidars", lidars_json(heard.layers, now)},
              {"processes", processes}}
      .dump(-1, ' ', false, json::error_handler_t::replace);  // names come from the bus
}

}  // namespace gvom::bridge
