#include <memory>
#include <string>
#include <thread>

#include "services/bridge/ros2/open_sink.hpp"
#include "services/bridge/ros2/settings.hpp"
#include "tests/dds/cdr_bytes.hpp"
#include "tests/dds/network.hpp"
#include "tests/dds/peer_process.hpp"

using namespace gvom;
using namespace gvom::bridge;
using namespace gvom::dds::test;
using Catch::Contains;

namespace {

services::VehicleConfig config_of(int domain) {
  services::VehicleConfig config;
  config.path = "vehicle.yaml";
  config.bridge.ros2.distro = "jazzy";
  config.bridge.ros2.domain = domain;
  config.bridge.ros2.interface = "lo";
  return config;
}

std::unique_ptr<Sink> open(const services::VehicleConfig& config) {
  auto sink = open_ros2_sink(config);
  REQUIRE(sink);
  REQUIRE(*sink);
  return std::move(*sink);
}

template <typename Condition>
bool eventually(const Condition& condition) {
  for (int i = 0; i < 400; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

std::string grid_line(std::uint32_t cells) {
  return "grid " + std::to_string(cells) + " x 1 of 0.25 m at 7.500000000 in odom, cost " +
         std::to_string(sum_of(Bytes(cells, 9)));
}

}  // namespace

TEST_CASE("without a distro there is no sink to ROS 2") {
  const auto sink = open_ros2_sink({});
  REQUIRE(sink);
  CHECK(*sink == nullptr);
}

TEST_CASE("a topic is wanted once somebody listens, a latched one before that") {
  services::VehicleConfig config = config_of(31);
  config.bridge.ros2.node = "/front/gvom";
  const auto sink = open(config);
  REQUIRE(eventually([&] { return sink->wants(topic(TopicId::costmap)); }));
  CHECK_FALSE(sink->wants(topic(TopicId::points)));

  sink->offer(topic(TopicId::costmap), 0, grid_message(8, 1, Bytes(8, 9)));
  REQUIRE(eventually([&] { return sink->counters().sent == 1; }));
  Peer late({"31", "hear-grid", "/front/gvom/costmap"});
  CHECK(late.line("grid") == grid_line(8));

  Peer viewer({"31", "hear-cloud", "/front/gvom/points"});
  REQUIRE(eventually([&] { return sink->wants(topic(TopicId::points)); }));
  REQUIRE_FALSE(viewer.line("matched").empty());
  const auto cloud = cloud_message(1, Bytes(64, 3));
  sink->offer(topic(TopicId::points), 0, cloud);
  CHECK_THAT(viewer.line("cloud"), Contains("cloud 2 of 64 bytes"));
  REQUIRE(eventually([&] { return sink->counters().clients == 2 && sink->counters().sent == 2; }));
  CHECK(sink->counters().bytes == cloud->size() + grid_message(8, 1, Bytes(8, 9))->size());
  CHECK(sink->counters().dropped == 0);
  CHECK(sink->problem().empty());
}

TEST_CASE("what is not asked for is not offered: /tf and what ROS has no type for") {
  const auto sink = open(config_of(32));
  REQUIRE(eventually([&] { return sink->wants(topic(TopicId::costmap)); }));
  for (const TopicId id : {TopicId::tf, TopicId::layers, TopicId::status})
    CHECK_FALSE(sink->wants(topic(id)));
}

TEST_CASE("a network that is not there is told, and looked for until it is") {
  services::VehicleConfig config = config_of(33);
  config.bridge.ros2.interface = "nosuch0";
  const auto sink = open(config);
  REQUIRE(eventually([&] { return !sink->problem().empty(); }));
  CHECK_THAT(sink->problem(), Contains("nosuch0"));
  CHECK_FALSE(sink->wants(topic(TopicId::costmap)));
}

TEST_CASE("where there is nothing but the loopback its peers get what is sent, without a name for it") {
  services::VehicleConfig config = config_of(35);
  config.bridge.ros2.interface = "";
  const auto sink = open(config);
  REQUIRE(eventually([&] { return sink->wants(topic(TopicId::costmap)); }));
  sink->offer(topic(TopicId::costmap), 0, grid_message(8, 1, Bytes(8, 9)));
  Peer viewer({"35", "hear-grid", "/gvom/costmap"});
  CHECK(viewer.line("grid") == grid_line(8));
  CHECK(sink->problem().empty());
}

TEST_CASE("keys that cannot be are told by name") {
  const auto error = [](auto change) {
    services::VehicleConfig config = config_of(34);
    change(config.bridge.ros2);
    return ros2_settings(config).error().text();
  };
  CHECK(error([](Ros2Config& keys) { keys.distro = "foxy"; }) ==
        "vehicle.yaml: bridge.ros2.distro: expected humble or jazzy, or nothing, not 'foxy'");
  CHECK(error([](Ros2Config& keys) { keys.node = "gvom"; }) ==
        "vehicle.yaml: bridge.ros2.node: node 'gvom' does not begin with a slash");
  CHECK_THAT(error([](Ros2Config& keys) { keys.topics = "/gvom/cost"; }),
             Contains("bridge.ros2.topics: there is no '/gvom/cost'; expected some of: /gvom/costmap"));
  CHECK(error([](Ros2Config& keys) { keys.topics = "/gvom/status"; }) ==
        "vehicle.yaml: bridge.ros2.topics: /gvom/status is no message of ROS's");
  CHECK(error([](Ros2Config& keys) { keys.peers = "10.0.0.1, a b"; }) ==
        "vehicle.yaml: bridge.ros2: peer 'a b' is no name or address");
  CHECK_THAT(error([](Ros2Config& keys) { keys.config_file = "/nowhere"; }),
             Contains("'/nowhere' cannot be read"));
}

TEST_CASE("topics are named after the node") {
  CHECK(topic_of_node("/gvom/costmap", "/gvom") == "/gvom/costmap");
  CHECK(topic_of_node("/gvom/costmap", "/front/map") == "/front/map/costmap");
  CHECK(topic_of_node("/diagnostics", "/front/map") == "/diagnostics");
}
