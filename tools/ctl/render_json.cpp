#include <nlohmann/json.hpp>

#include "ipc/text.hpp"
#include "tools/ctl/render.hpp"

namespace gvom::ctl {

namespace {

using Json = nlohmann::ordered_json;

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json text_or_null(const std::string& text) {
  return text.empty() ? Json() : Json(text);
}

Json json_of(const std::optional<GroundView>& ground) {
  if (!ground) return Json();
  Json json = {{"verdict", to_string(ground->verdict)},
               {"sweeps", ground->sweeps},
               {"on_the_way", ground->on_the_way},
               {"height_m", Json()},
               {"slope_x", Json()},
               {"slope_y", Json()}};
  if (ground->sweeps == 0) return json;
  json["height_m"] = ground->height_m;
  json["slope_x"] = ground->slope_x;
  json["slope_y"] = ground->slope_y;
  return json;
}

Json json_of(const ProcessView& process) {
  Json json = {{"name", process.name},
               {"state", to_string(process.state)},
               {"reason", process.reason},
               {"pid", or_null(process.pid)},
               {"rate_hz", or_null(process.rate_hz)},
               {"health_age_s", or_null(process.health_age_s)},
               {"data_age_s", or_null(process.data_age_s)},
               {"restarts", or_null(process.restarts)},
               {"memory_bytes", process.usage ? Json(process.usage->private_bytes) : Json()},
               {"cpu_s", process.usage ? Json(process.usage->cpu_s) : Json()},
               {"ground", json_of(process.ground)},
               {"backend", process.backend},
               {"backend_details", process.backend_details},
               {"version", text_or_null(process.version)},
               {"config_hash", text_or_null(process.config_hash)},
               {"other_version", process.other_version},
               {"other_config", process.other_config},
               {"drops", Json::object()},
               {"counters", Json::object()},
               {"stages", Json::object()}};
  for (const Drop& drop : process.drops)
    json["drops"][drop.reason] = {{"count", drop.count}, {"per_s", or_null(drop.per_s)}};
  for (const auto& [name, value] : process.counters) json["counters"][name] = value;
  for (const ipc::Health::Stage& stage : process.stages)
    json["stages"][std::string(ipc::text_of(stage.name))] = {
        {"p50_ms", stage.p50_ms}, {"p99_ms", stage.p99_ms}, {"max_ms", stage.max_ms}};
  return json;
}

Json json_of(const LayersView& layers) {
  Json json = {{"age_s", layers.age_s},  // an infinite one prints as null
               {"publish_age_s", layers.publish_age_s},
               {"maps_in_window", layers.maps_in_window},
               {"missing", Json::array()},
               {"lidars", Json::object()}};
  for (const LidarView& lidar : layers.lidars) {
    if (lidar.missing) json["missing"].push_back(lidar.name);
    json["lidars"][lidar.name] = {{"missing", lidar.missing},
                                  {"unknown", lidar.unknown},
                                  {"maps_in_window", lidar.maps_in_window},
                                  {"maps_lost", lidar.maps_lost},
                                  {"columns_seen_fraction", lidar.columns_seen_fraction}};
  }
  return json;
}

const char* word_of(BrokerState state) {
  switch (state) {
    case BrokerState::absent:
      return "absent";
    case BrokerState::hung:
      return "hung";
    case BrokerState::up:
      return "up";
  }
  return "unknown";
}

}  // namespace

std::string to_json(const Snapshot& snapshot) {
  Json json = {{"vehicle", snapshot.vehicle},
               {"version", text_or_null(snapshot.version)},
               {"config_hash", text_or_null(snapshot.config_hash)},
               {"config_error", text_or_null(snapshot.config_error)},
               {"ok", snapshot.problems.empty()},
               {"problems", snapshot.problems},
               {"broker", word_of(snapshot.broker.state)},
               {"processes", Json::array()},
               {"layers", snapshot.layers ? json_of(*snapshot.layers) : Json()},
               {"odometry", Json()},
               {"pools", Json::array()}};
  for (const ProcessView& process : snapshot.processes) json["processes"].push_back(json_of(process));
  if (snapshot.odometry)
    json["odometry"] = {{"age_s", snapshot.odometry->age_s},
                        {"rate_hz", or_null(snapshot.odometry->rate_hz)}};
  for (const ipc::PoolUse& pool : snapshot.pools)
    json["pools"].push_back({{"chunk_bytes", pool.chunk_bytes},
                             {"chunks", pool.chunks},
                             {"used", pool.used},
                             {"min_free", pool.min_free}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace gvom::ctl
