// gvom-bridge on the bus: what fusion makes reaches a Foxglove client and a file; its end harms neither.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "services/common/ros/schemas.hpp"
#include "tests/bridge/bridge_rig.hpp"
#include "tests/bridge/mcap_file.hpp"
#include "tests/bridge/schema_reader.hpp"

namespace {

using namespace gvom;
using nlohmann::json;
using test::Rig;
using test::WsClient;

// Channels by their place in kTopics.
constexpr std::uint32_t kCostmap = 1, kVoxels = 5, kTf = 6, kDiagnostics = 9, kStatus = 10;

std::uint32_t subscription_of(const test::WsMessage& message) {
  std::uint32_t id;
  std::memcpy(&id, message.bytes.data() + 1, sizeof id);
  return id;
}

/// The first message of each of the channels, without its head.
std::map<std::uint32_t, std::vector<std::uint8_t>> first_of(WsClient& client,
                                                            const std::vector<std::uint32_t>& channels) {
  for (const std::uint32_t channel : channels) REQUIRE(client.subscribe(channel, channel));
  std::map<std::uint32_t, std::vector<std::uint8_t>> first;
  for (int i = 0; i < 2000 && first.size() < channels.size(); ++i) {
    const auto message = client.read_data();
    if (!message) break;
    const std::uint32_t id = subscription_of(*message);
    if (std::find(channels.begin(), channels.end(), id) != channels.end())
      first.try_emplace(id, message->bytes.begin() + 13, message->bytes.end());
  }
  return first;
}

/// The next status of a client that has subscribed to it.
json next_status(WsClient& client) {
  while (true) {
    const auto message = client.read_data();
    REQUIRE(message);
    if (subscription_of(*message) == kStatus)
      return json::parse(message->bytes.begin() + 13, message->bytes.end());
  }
}

bool names_fusion(const json& status) {
  const json& processes = status["processes"];
  return std::count_if(processes.begin(), processes.end(),
                       [](const json& process) { return process["name"] == "gvom-fusion"; }) == 1;
}

TEST_CASE("a Foxglove client gets the map, and the file is whole after a stop") {
  Rig rig;
  rig.start();
  const auto client = rig.client();
  INFO(rig.bridge->output());
  REQUIRE(client);
  // Layers first: the status then has what it is asked for.
  REQUIRE(first_of(*client, {kCostmap}).size() == 1);
  auto first = first_of(*client, {kVoxels, kTf, kDiagnostics, kStatus});
  REQUIRE(first.size() == 4);
  const json cloud = test::read_message(*ros::schema_of("sensor_msgs/msg/PointCloud2"), first[kVoxels]);
  CHECK(cloud["width"].get<int>() > 100);
  const json tf = test::read_message(*ros::schema_of("tf2_msgs/msg/TFMessage"), first[kTf]);
  CHECK(tf["transforms"][0]["child_frame_id"] == "base_link");
  json status = json::parse(first[kStatus]);
  CHECK(status["lidars"][0]["name"] == "front");
  CHECK(status["layers"]["age_s"].get<double>() < 60);
  for (int i = 0; i < 20 && !names_fusion(status); ++i) status = next_status(*client);  // its first Health
  CHECK(names_fusion(status));

  CHECK(rig.bridge->stop() == 0);
  const auto files = rig.recorded();
  REQUIRE(files.size() == 1);
  const test::McapFile file = test::read_mcap(files[0]);
  CHECK(file.finished);
  CHECK(file.counted == file.messages.size());
  std::set<std::string> topics;
  for (const test::McapMessage& message : file.messages) topics.insert(message.topic);
  for (const char* topic :
       {"/gvom/costmap", "/gvom/layers", "/gvom/voxels", "/tf", "/diagnostics", "/gvom/status"})
    CHECK(topics.count(topic) == 1);
  rig.end();
}

TEST_CASE("an outage is as long in the file as it was") {
  Rig rig;
  rig.start();
  const auto client = rig.client();
  REQUIRE(client);
  REQUIRE(first_of(*client, {kCostmap}).size() == 1);
  rig.odometry->kill_asleep();
  REQUIRE(client->subscribe(kStatus, kStatus));
  for (int told = 0; told < 4; ++told) next_status(*client);
  CHECK(rig.bridge->stop() == 0);
  std::vector<std::uint64_t> told_ns;
  for (const test::McapMessage& message : test::read_mcap(rig.recorded()[0]).messages)
    if (message.topic == "/gvom/status") told_ns.push_back(message.log_ns);
  REQUIRE(told_ns.size() >= 4);
  for (std::size_t i = told_ns.size() - 2; i < told_ns.size(); ++i) {
    const std::uint64_t gap_ns = told_ns[i] - told_ns[i - 1];
    CHECK(gap_ns >= 1'000'000'000);
    CHECK(gap_ns < 10'000'000'000);  // how late it is told, a busy machine decides
  }
  rig.graph.stop();
}

TEST_CASE("after kill -9 the file has what was recorded, and the map goes on") {
  Rig rig;
  rig.start();
  const auto client = rig.client();
  REQUIRE(client);
  REQUIRE(first_of(*client, {kCostmap}).size() == 1);
  const auto has_messages = [&] {  // a chunk may be half written
    const auto files = rig.recorded();
    return !files.empty() && std::filesystem::file_size(files[0]) > 8 &&
           test::read_mcap(files[0]).messages.size() > 1;
  };
  REQUIRE(test::eventually(has_messages));
  CHECK(rig.bridge->kill_asleep() == 128 + SIGKILL);
  const test::McapFile file = test::read_mcap(rig.recorded()[0]);
  CHECK(!file.finished);
  CHECK(file.messages.size() > 1);
  CHECK(rig.graph.fusion().runs());
  rig.bridge = rig.graph.start("gvom-bridge", {});
  const auto again = rig.client();
  REQUIRE(again);
  CHECK(first_of(*again, {kCostmap}).size() == 1);
  CHECK(rig.bridge->stop() == 0);
  rig.end();
}

TEST_CASE("gvom-map writes the same messages into a file, and says which file it cannot write") {
  const test::TemporaryFolder folder;
  test::Vehicle vehicle = Rig::front(folder.path());
  for (const std::string& set : test::small_map()) vehicle.sets.push_back(set);
  const std::string path = folder.path() + "/drive.mcap";
  const test::Ended ended = test::run("gvom-map", vehicle.arguments({"--mcap", path}), folder.path());
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  const test::McapFile file = test::read_mcap(path);
  CHECK(file.finished);
  std::map<std::string, int> messages;
  for (const test::McapMessage& message : file.messages) ++messages[message.topic];
  CHECK(messages.size() == 6);
  for (const auto& [topic, count] : messages) CHECK(count == messages["/tf"]);
  CHECK(messages["/tf"] > 10);
  const test::Ended full = test::run("gvom-map", vehicle.arguments({"--mcap", "/dev/full"}), folder.path());
  CHECK(full.code == 69);
  CHECK_THAT(full.output, Catch::Contains("/dev/full: No space left"));
}

TEST_CASE("a key that names no layer is told before anything runs") {
  const test::TemporaryFolder folder;
  test::Vehicle vehicle = Rig::front(folder.path());
  vehicle.sets = {"bridge.points_layers=hight"};
  const test::Ended ended = test::run("gvom-bridge", vehicle.arguments({"--check"}), folder.path());
  CHECK(ended.code == 78);
  CHECK_THAT(ended.output, Catch::Contains("bridge.points_layers: there is no 'hight'"));
}

}  // namespace
