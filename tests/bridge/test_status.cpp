// /gvom/status: ages, lidars and processes, with what is not known as null.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ipc/text.hpp"
#include "services/bridge/status.hpp"

namespace {

using namespace gvom;
using nlohmann::json;

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr ipc::Moment kNow{100 * kSecond_ns, 0};

ipc::Layers layers_of_two() {
  ipc::Layers layers{};
  layers.header.stamp_ns = 50 * kSecond_ns;
  layers.mono_received_ns = kNow.mono_ns - kSecond_ns / 4;
  layers.mono_published_ns = kNow.mono_ns - kSecond_ns / 8;
  layers.maps_in_window = 9;
  layers.lidar_count = 3;
  ipc::set_text(layers.lidars[0].name, "front");
  layers.lidars[0].newest_stamp_ns = 50 * kSecond_ns;
  layers.lidars[0].columns_seen_fraction = 0.5F;
  ipc::set_text(layers.lidars[1].name, "rear");
  layers.lidars[1].newest_stamp_ns = 48 * kSecond_ns;
  layers.lidars[1].missing = 1;
  ipc::set_text(layers.lidars[2].name, "new");
  layers.lidars[2].missing = layers.lidars[2].unknown = 1;
  return layers;
}

ipc::Health fusion() {
  ipc::Health health{};
  ipc::set_text(health.process, "gvom-fusion");
  health.state = static_cast<std::uint32_t>(ipc::HealthState::degraded);
  ipc::set_text(health.reason, "the layers were 2.1 s behind");
  health.mono_ns = kNow.mono_ns - kSecond_ns / 2;
  health.rate_hz = NAN;
  health.counter_count = 2;
  ipc::set_text(health.counters[0].name, "maps");
  health.counters[0].value = 7;
  ipc::set_text(health.counters[1].name, "drop_map_lost");
  health.counters[1].value = 2;
  health.stage_count = 1;
  ipc::set_text(health.stages[0].name, "fuse");
  health.stages[0].p99_ms = 4.5;
  return health;
}

TEST_CASE("a lidar is as much older than the layers as its newest stamp is than the newest of all") {
  bridge::Heard heard;
  heard.vehicle = "truck";
  heard.layers = layers_of_two();
  const json status = json::parse(bridge::status_json(heard, kNow));
  CHECK(status["vehicle"] == "truck");
  CHECK(
      status["layers"] ==
      json{{"age_s", 0.25}, {"publish_age_s", 0.125}, {"maps_in_window", 9}, {"stamp_ns", 50 * kSecond_ns}});
  const json& lidars = status["lidars"];
  REQUIRE(lidars.size() == 3);
  CHECK(lidars[0]["age_s"] == 0.25);
  CHECK(lidars[0]["missing"] == false);
  CHECK(lidars[0]["columns_seen_fraction"] == 0.5);
  CHECK(lidars[1]["age_s"] == 2.25);
  CHECK(lidars[1]["missing"] == true);
  CHECK(lidars[2]["age_s"].is_null());
  CHECK(lidars[2]["unknown"] == true);
}

TEST_CASE("a process says how it is; one that is silent is told so") {
  bridge::Heard heard;
  heard.processes = {fusion()};
  json process = json::parse(bridge::status_json(heard, kNow))["processes"][0];
  CHECK(process["name"] == "gvom-fusion");
  CHECK(process["state"] == "degraded");
  CHECK(process["reason"] == "the layers were 2.1 s behind");
  CHECK(process["rate_hz"].is_null());
  CHECK(process["heard_s"] == 0.5);
  CHECK(process["counters"] == json{{"maps", 7}});
  CHECK(process["drops"] == json{{"drop_map_lost", 2}});
  CHECK(process["stages"]["fuse"]["p99_ms"] == 4.5);
  heard.processes[0].mono_ns = kNow.mono_ns - 4 * kSecond_ns;
  process = json::parse(bridge::status_json(heard, kNow))["processes"][0];
  CHECK(process["state"] == "silent");
}

TEST_CASE("before anything came there is a status, and what a process calls itself breaks none") {
  bridge::Heard heard;
  CHECK(json::parse(bridge::status_json(heard, kNow))["layers"].is_null());
  CHECK(json::parse(bridge::status_json(heard, kNow))["odometry"].is_null());
  heard.processes = {fusion()};
  ipc::set_text(heard.processes[0].process, "\xff\xfe\"\n");
  heard.processes[0].counter_count = heard.processes[0].stage_count = 4'000'000'000;
  heard.layers = layers_of_two();
  heard.layers->lidar_count = 4'000'000'000;
  CHECK(json::parse(bridge::status_json(heard, kNow))["lidars"].size() == kMaxLidars);
}

}  // namespace
