#include "tests/dds/robot_graph.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/processes/recordings.hpp"

namespace gvom::dds::test {

using gvom::ipc::test::eventually;
using gvom::test::Graph;
using gvom::test::Observer;
using gvom::test::Vehicle;

namespace {

/// The file's places are %N.
constexpr const char* kVehicle =
    "name: robot\n"
    "odometry: {source: '%1', max_clock_offset_s: 60}\n"
    "bridge:\n"
    "  grid_map_layers: 'height,slope,roughness,obstacle_density,clearance,cost'\n"
    "  foxglove: {port: %2}\n"
    "  mcap: {folder: recorded}\n"
    "  ros2: {distro: jazzy, interface: lo, domain: %3}\n"
    "lidars:\n"
    "  top:\n"
    "    source: '%4'\n"
    "    T_base_sensor: {x: 0, y: 0, z: 1.7, roll: 0, pitch: 0, yaw: 0}\n";

Vehicle vehicle_in(const std::string& folder, const std::string& domain, Input input) {
  const std::string network = "?interface=lo&domain=" + domain;
  const bool live = input != Input::recording;
  const std::string pose =
      input == Input::tf ? "ros2:/tf" + network + "&tf=odom/base_link" : "ros2:/odom" + network;
  if (!live) gvom::test::simulated(folder, 2.0);
  std::string text = kVehicle;
  for (const auto& [place, value] :
       {std::pair<std::string, std::string>("%1", live ? pose : "tum:odometry.tum"),
        {"%2", std::to_string(gvom::test::free_port())},
        {"%3", domain},
        {"%4", live ? "ros2:/points" + network : "ouster:front.pcap?meta=front.json"}})
    text.replace(text.find(place), place.size(), value);
  std::ofstream(folder + "/robot.yaml") << text;
  return {folder + "/robot.yaml", {"top"}, folder, gvom::test::small_map()};
}

}  // namespace

RobotGraph::RobotGraph(int domain, Input input) : domain_(std::to_string(domain)), input_(input) {
  graph = std::make_unique<Graph>(vehicle_in(folder.path(), domain_, input));
  observer = std::make_unique<Observer>(folder.path());
  REQUIRE(observer->is_up());
  graph->start_readers();
  odometry = graph->replay(input != Input::recording ? std::vector<std::string>{}
                                                     : std::vector<std::string>{"--rate", "1", "--loop"});
  bridge = graph->start("gvom-bridge", {});
  REQUIRE(graph->ingest("top").says("top from"));
  REQUIRE(eventually([this] { return observer->health("gvom-bridge").has_value(); }));
}

std::unique_ptr<Peer> RobotGraph::drive(int points) const {
  std::vector<std::string> arguments{domain_, "drive", std::to_string(points), "10"};
  if (input_ == Input::tf) arguments.push_back("tf");
  auto robot = std::make_unique<Peer>(arguments, "dds_robot");
  REQUIRE_FALSE(robot->line("ready").empty());
  return robot;
}

std::unique_ptr<Peer> RobotGraph::look(const std::string& topic, const std::string& type) const {
  const std::vector<std::string> arguments{domain_, "look", topic + "=" + type};
  return std::make_unique<Peer>(arguments, "dds_robot");
}

std::uint64_t RobotGraph::of_ingest(const std::string& counter) const {
  return observer->counter("gvom-ingest-top", counter);
}

std::uint64_t RobotGraph::of_bridge(const std::string& counter) const {
  return observer->counter("gvom-bridge", counter);
}

bool RobotGraph::layers_flow() const {
  const std::uint64_t before = observer->layers();
  return eventually([&] { return observer->layers() >= before + 5; });
}

bool RobotGraph::recording_flows() const {
  const std::uint64_t before = of_bridge("mcap_sent");
  return eventually([&] { return of_bridge("mcap_sent") > before + 5; });
}

std::string RobotGraph::reason(const std::string& process) const {
  const auto health = observer->health(process);
  return health ? health->reason : "";
}

void RobotGraph::stop() {
  CHECK(bridge->stop() == 0);
  CHECK(odometry->stop() == 0);
  graph->stop();
}

}  // namespace gvom::dds::test
