// Foxglove's own readers against what gvom-map writes, and what gvom-bridge records and sends.
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

namespace {

using namespace gvom;

const std::string kOfLayers = "/gvom/costmap,/gvom/grid_map,/gvom/layers,/gvom/points,/gvom/voxels,/tf";
const std::string kAll = kOfLayers + ",/diagnostics,/gvom/status";
const std::string kSize = "128";  // of test::small_map()

/// Runs a script of this folder (GVOM_READERS: with its packages).
test::Ended node(const std::string& script, const std::vector<std::string>& arguments) {
  const char* folder = std::getenv("GVOM_READERS");
  REQUIRE(folder != nullptr);
  std::string command = "exec 2>&1 node '" + std::string(folder) + "/" + script + "'";
  for (const std::string& argument : arguments) command += " '" + argument + "'";
  test::Ended ended{-1, ""};
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  char line[1024];
  while (std::fgets(line, sizeof line, pipe) != nullptr) ended.output += line;
  ended.code = ::pclose(pipe);
  return ended;
}

void must_be_well(const std::string& script, const std::vector<std::string>& arguments) {
  const test::Ended ended = node(script, arguments);
  INFO(ended.output);
  CHECK(ended.code == 0);
  CHECK_THAT(ended.output, Catch::Contains("well: "));
}

test::Vehicle crawling(const std::string& path) {
  test::simulated(path, 2.0, test::kCrawling_mps);
  return test::front_only(path);
}

TEST_CASE(
    "gvom-map's MCAP file has the layers that it writes as arrays, and costs, points and voxels of them") {
  const test::TemporaryFolder folder;
  const test::Vehicle vehicle = crawling(folder.path());
  const std::string file = folder.path() + "/drive.mcap", maps = folder.path() + "/maps";
  const test::Ended ended =
      test::run("gvom-map", vehicle.arguments({"--mcap", file, "--out", maps}), folder.path());
  INFO(ended.output);
  REQUIRE(ended.code == 0);
  must_be_well("read_mcap.js", {file, kSize, kOfLayers, maps + "/000010"});
}

TEST_CASE("what gvom-bridge sends by both subprotocols, and what it records, are the drive's messages") {
  const test::TemporaryFolder folder;
  const std::string port = std::to_string(test::free_port()), recorded = folder.path() + "/recorded";
  test::Vehicle vehicle = crawling(folder.path());
  vehicle.sets.insert(vehicle.sets.end(), {"fusion.voxel_rate_hz=10", "bridge.foxglove.port=" + port,
                                           "bridge.mcap.folder=" + recorded, "bridge.mcap.topics=" + kAll});
  test::Graph graph(vehicle);
  graph.start_readers();
  const auto bridge = graph.start("gvom-bridge", {});
  const auto odometry = graph.replay({"--rate", "1", "--loop"});
  REQUIRE(bridge->says("foxglove: at 127.0.0.1"));
  for (const char* subprotocol : {"foxglove.websocket.v1", "foxglove.sdk.v1"})
    must_be_well("read_live.js", {port, subprotocol, kSize, kAll});
  CHECK(bridge->stop() == 0);
  odometry->stop();
  graph.stop();
  const auto file = std::filesystem::directory_iterator(recorded)->path().string();
  must_be_well("read_mcap.js", {file, kSize, kAll});
}

}  // namespace
