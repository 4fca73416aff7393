// The example planner on remembered ground, and the example driver.
#include <catch2/catch.hpp>

#include <algorithm>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "core/format/layers.hpp"
#include "ipc/fixed.hpp"
#include "ipc/runtime.hpp"
#include "tests/processes/layers_log.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using ipc::test::eventually;
using namespace std::chrono_literals;

namespace {

constexpr int kMostCost = 252;  // of ground that can be driven on (R16)
constexpr int kUnknownCost = 255;
constexpr int kRememberedCost = 50;

struct Ahead {
  int cost;
  bool remembered;
};

/// A line that the example printed.
struct Line {
  std::vector<Ahead> ahead;
  bool front_missing;
};

std::vector<Line> lines_of(const std::string& output) {
  static const std::regex column(" +(\\d+)(r?)(?= )");
  std::vector<Line> lines;
  std::istringstream text(output);
  for (std::string words; std::getline(text, words);) {
    const auto age = words.find("  age ");
    if (words.rfind("cost ahead:", 0) != 0 || age == std::string::npos) continue;
    Line line{{}, words.find("missing: front") != std::string::npos};
    const std::string costs = words.substr(0, age + 1);
    for (std::sregex_iterator match(costs.begin(), costs.end(), column), end; match != end; ++match)
      line.ahead.push_back({std::stoi((*match)[1]), (*match)[2].length() > 0});
    lines.push_back(line);
  }
  return lines;
}

/// What the planner makes of the columns that are remembered, or of the others, in the lines that name the
/// front lidar as missing, or in the others.
std::vector<int> costs(const std::vector<Line>& lines, bool front_missing, bool remembered) {
  std::vector<int> found;
  for (const Line& line : lines)
    for (const Ahead& ahead : line.ahead)
      if (line.front_missing == front_missing && ahead.remembered == remembered) found.push_back(ahead.cost);
  return found;
}

int count_within(const std::vector<int>& costs, int least, int most) {
  return static_cast<int>(
      std::count_if(costs.begin(), costs.end(), [=](int cost) { return cost >= least && cost <= most; }));
}

bool has_drivable_remembered(const LoggedLayers& layers) {
  for (std::size_t i = 0; i < LoggedLayers::kColumns; ++i)
    if (is_remembered(layers.visibility[i]) && layers.cost[i] <= kMostCost) return true;
  return false;
}

}  // namespace

TEST_CASE("the example planner pays for remembered ground, and drives on none beside a missing lidar") {
  const TemporaryFolder folder;
  Vehicle vehicle = simulated(folder.path(), 4);
  // The ring that no lidar sees is wide, and what is assumed of it small: ground just ahead is remembered.
  vehicle.sets.insert(vehicle.sets.end(), {"lidars.front.min_range_m=6", "lidars.rear.min_range_m=6",
                                           "vehicle.radius_m=1", kRoomForLayersLog});
  Graph graph(vehicle);
  const LayersLog log;
  REQUIRE(log.is_up());
  graph.start_readers();
  Program planner("gvom-example-planner", {}, folder.path());
  const auto odometry = graph.replay({"--rate", "0.5"});
  REQUIRE(eventually([&] { return costs(lines_of(planner.output()), false, true).size() >= 10; }));
  graph.lose_ingest("front");
  CHECK(odometry->wait() == 0);
  planner.kill();
  graph.stop();
  INFO(planner.output());
  const auto lines = lines_of(planner.output());

  CHECK(count_within(costs(lines, false, false), 0, kRememberedCost - 1) > 0);
  CHECK(count_within(costs(lines, false, true), 0, kRememberedCost - 1) == 0);
  CHECK(count_within(costs(lines, false, true), kRememberedCost, kMostCost) > 0);
  CHECK(count_within(costs(lines, true, true), 0, kMostCost) == 0);
  CHECK(count_within(costs(lines, true, true), kUnknownCost, kUnknownCost) > 0);
  CHECK(count_within(costs(lines, true, false), 0, kMostCost) > 0);
  // The map's own cost does not tell.
  CHECK(log.newest().lidar("front").missing == 1);
  CHECK(has_drivable_remembered(log.newest()));
}

TEST_CASE(
    "the example driver commands a speed with a deadline while layers come, and stands when a lidar dies") {
  const TemporaryFolder folder;
  Vehicle vehicle = simulated(folder.path(), 4);
  Graph graph(vehicle);
  graph.start_readers();
  Program driver("gvom-example-driver", {}, folder.path());
  ipc::test::Step drives, stands;
  ipc::test::Child listener([&] {
    auto runtime = ipc::Runtime::connect("listener", 5s).value();
    auto commands = ipc::Subscriber<ipc::Command>::open(runtime).value();
    while (true) {
      const auto command = ipc::test::take_within(commands);
      EXPECT(command);
      const std::int64_t left_ns = (*command)->mono_deadline_ns - ipc::monotonic_ns();
      EXPECT(left_ns < 250'000'000);
      if ((*command)->speed_mps == 1.0) drives.reach(1);
      if ((*command)->speed_mps == 0.0 && drives.reached(1)) stands.reach(1);
    }
  });
  const auto odometry = graph.replay({"--rate", "1", "--loop"});
  CHECK(drives.wait_for(1));
  graph.lose_ingest("front");
  CHECK(stands.wait_for(1));
  CHECK(eventually([&] { return driver.output().find("stands: not free ahead") != std::string::npos; }));
  CHECK(odometry->stop() == 0);
  driver.kill();
  graph.stop();
}
