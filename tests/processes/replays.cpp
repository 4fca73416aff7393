#include "tests/processes/replays.hpp"

#include <catch2/catch.hpp>

#include "tests/processes/results.hpp"

namespace gvom::test {

void check_all_mapped(Graph& graph, int expected_maps, bool lossless) {
  int mapped = 0;
  for (const std::string& lidar : graph.vehicle().lidars) {
    const std::string output = graph.ingest(lidar).output();
    INFO(output);
    const auto numbers = numbers_before(output, "sweeps mapped");
    REQUIRE(numbers.size() == 2);
    CHECK(numbers[0] == numbers[1]);
    mapped += numbers[0];
  }
  CHECK(mapped == expected_maps);
  const std::string output = graph.fusion().output();
  INFO(output);
  CHECK(numbers_before(output, "maps fused") == std::vector<int>{expected_maps});
  const auto layers = numbers_before(output, "layers published");
  REQUIRE(layers.size() == 1);
  CHECK(layers[0] <= expected_maps);
  CHECK(layers[0] >= (lossless ? expected_maps : 1));
}

void check_replay(const Vehicle& vehicle, const std::string& rate, const std::string& expected_maps) {
  INFO("--rate " << rate);
  const std::string pictures = vehicle.folder + "/pictures-" + rate;
  Graph graph(vehicle);
  graph.start_readers();
  const auto snapshot = graph.start("gvom-snapshot", {"--out", pictures, "--final", "--npy"});
  graph.play_through(rate);
  const int code = snapshot->stop();
  INFO(snapshot->output());
  REQUIRE(code == 0);
  graph.stop();
  CHECK(differences(last_map(expected_maps), last_map(pictures)) == "");
  check_all_mapped(graph, map_count(expected_maps), rate == "max");
}

}  // namespace gvom::test
