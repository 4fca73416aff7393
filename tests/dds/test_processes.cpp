// gvom-ingest and gvom-bridge among peers that stop and die, and on a network that comes and goes.
#include <signal.h>

#include <cstdlib>
#include <fstream>

#include "tests/dds/network.hpp"
#include "tests/dds/robot_graph.hpp"

using namespace gvom;
using namespace gvom::dds::test;
using Catch::Contains;
using gvom::ipc::test::eventually;

namespace {

constexpr const char* kIngest = "gvom-ingest-top";
constexpr const char* kGridMap = "/gvom/grid_map";
constexpr const char* kGridMapType = "grid_map_msgs/msg/GridMap";
constexpr const char* kUp = "ip link set lo up && ip route add 224.0.0.0/4 dev lo";
constexpr int kFewPoints = 4000;  // 128 kB: any buffer has room for them

/// The number that the writer gave to the next message that the reader says it got; 0 if none comes.
long long next_number(Peer& reader) {
  const std::string line = reader.line("got");
  return line.empty() ? 0 : std::stoll(line.substr(line.rfind(' ')));
}

/// The reader gets messages until it has one of that number or a later one.
bool gets(Peer& reader, long long number) {
  for (long long got = 1; got != 0;) {
    got = next_number(reader);
    if (got >= number) return true;
  }
  return false;
}

bool tells(const RobotGraph& robots, const std::string& process, const std::string& what) {
  return robots.reason(process).find(what) != std::string::npos;
}

std::uint64_t own_memory_bytes(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("RssAnon:", 0) == 0) return std::stoull(line.substr(8)) * 1024;
  return 0;
}

void run(const std::string& command) {
  INFO(command);
  REQUIRE(std::system(command.c_str()) == 0);
}

}  // namespace

TEST_CASE("readers that stop and are killed hold up neither the bridge nor other readers and sinks") {
  RobotGraph robots(61, Input::ros2);
  const auto driver = robots.drive(kFewPoints);
  const auto stopped = robots.look(kGridMap, kGridMapType);
  const auto killed = robots.look(kGridMap, kGridMapType);
  const auto well = robots.look(kGridMap, kGridMapType);
  for (Peer* reader : {stopped.get(), killed.get(), well.get()}) REQUIRE(next_number(*reader) > 0);
  REQUIRE(gets(*well, next_number(*well) + 15));  // its buffers have grown
  const std::uint64_t before_bytes = own_memory_bytes(robots.bridge->pid());

  stopped->send(SIGSTOP);
  killed->send(SIGKILL);
  const long long since = next_number(*well);
  CHECK(gets(*well, since + 40));
  CHECK(robots.recording_flows());
  CHECK(robots.layers_flow());
  // 40 messages of 400 kB would be seen.
  CHECK(eventually([&] { return own_memory_bytes(robots.bridge->pid()) < before_bytes + 8'000'000; }));
  stopped->send(SIGCONT);
  CHECK(gets(*stopped, since + 40));
  CHECK(robots.of_bridge("ros2_dropped") == 0);
  CHECK(robots.of_bridge("mcap_dropped") == 0);
  CHECK(robots.reason("gvom-bridge").empty());
  robots.stop();
}

TEST_CASE("a driver that is killed within a cloud leaves whole sweeps, and is told; the next one is mapped") {
  if (!has_large_buffers()) return;
  constexpr int kPoints = 120'000;
  RobotGraph robots(62, Input::tf);
  for (int i = 0; i < 3; ++i) {
    INFO("driver " << i);
    const auto driver = robots.drive(kPoints);
    const std::uint64_t mapped = robots.of_ingest("sweeps_mapped");
    REQUIRE(eventually([&] { return robots.of_ingest("sweeps_mapped") > mapped; }));
    REQUIRE_FALSE(driver->line("sending").empty());
    driver->send(SIGKILL);
    CHECK(eventually([&] { return tells(robots, kIngest, "no packets for"); }));
    CHECK(eventually([&] { return tells(robots, "gvom-odometry", "no odometry on /tf for"); }));
  }
  CHECK(robots.odometry->says("the pose of base_link in odom, by odom/base_footprint"));
  std::uint64_t returns = robots.of_ingest("returns_used");
  for (const char* filtered : {"near", "far", "body", "not_finite", "overflow"})
    returns += robots.of_ingest(std::string("drop_return_") + filtered);
  CHECK(returns == kPoints * robots.of_ingest("sweeps_mapped"));
  CHECK(robots.of_ingest("drop_packet_foreign") == 0);
  CHECK(robots.graph->fusion().runs());
  robots.stop();
}

TEST_CASE("without its interface the bridge says so and its other sinks go on; it joins when that is there") {
  run("ip link set lo down");
  RobotGraph robots(63, Input::recording);
  CHECK(eventually([&] { return tells(robots, "gvom-bridge", "ros2: ROS 2: "); }));
  CHECK_THAT(robots.reason("gvom-bridge"), Contains("lo"));
  CHECK(robots.recording_flows());

  run(kUp);
  const auto reader = robots.look("/gvom/costmap", "nav_msgs/msg/OccupancyGrid");
  CHECK(next_number(*reader) > 0);
  CHECK(eventually([&] { return robots.reason("gvom-bridge").empty(); }));

  run("ip link set lo down");
  CHECK(robots.bridge->says("ROS 2: the network that was joined is gone: 127.0.0.1 of lo"));
  while (!reader->line("got", std::chrono::seconds(1)).empty()) continue;
  CHECK(robots.recording_flows());
  CHECK(robots.layers_flow());
  run(kUp);
  CHECK(next_number(*reader) > 0);
  robots.stop();
}

TEST_CASE("who takes clouds or poses leaves when the network goes, to be started again") {
  RobotGraph robots(64, Input::ros2);
  REQUIRE(robots.odometry->runs());
  run("ip link set lo down");
  constexpr int kUnavailable = 69;
  CHECK(robots.graph->ingest("top").wait() == kUnavailable);
  CHECK(robots.odometry->wait() == kUnavailable);
  CHECK(robots.graph->ingest("top").says("the network that was joined is gone: 127.0.0.1 of lo"));
  run(kUp);
  CHECK(robots.bridge->stop() == 0);
}
