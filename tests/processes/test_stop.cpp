// SIGINT and SIGTERM end each process well, whatever it does at that moment.
#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/ipc/processes.hpp"
#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using gvom::ipc::test::eventually;
using gvom::ipc::test::takes_signals;
using namespace std::chrono_literals;

namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM};

void check_stops(Program& program, int signal) {
  const int code = program.stop(signal);
  INFO("signal " << signal << "\n" << program.output());
  CHECK(code == 0);
}

/// Waits until it waits for something.
bool waits(const Program& program) {
  return takes_signals(program.pid()) &&
         eventually([&] { return gvom::ipc::test::is_asleep(program.pid()); });
}

/// Waits until all have joined with all that they publish.
bool have_joined(const std::string& folder, const std::vector<std::string>& processes) {
  const Observer observer(folder);
  return std::all_of(processes.begin(), processes.end(), [&](const std::string& process) {
    return eventually([&] { return observer.health(process).has_value(); });
  });
}

std::unique_ptr<Program> endless_replay(const Graph& graph, const char* rate) {
  return graph.replay({"--rate", rate, "--loop"});
}

/// Waits for the first layers.
bool has_mapped(const std::string& folder, const Graph& graph) {
  const auto snapshot = graph.start("gvom-snapshot", {"--out", folder + "/first", "--once"});
  return snapshot->wait() == 0;
}

}  // namespace

TEST_CASE("each stops well while it waits for the broker") {
  const TemporaryFolder folder;
  const Vehicle vehicle = simulated(folder.path(), 0.2);
  for (const int signal : kSignals) {
    Program fusion("gvom-fusion", vehicle.arguments(), folder.path());
    Program ingest("gvom-ingest", vehicle.arguments({"--lidar", "front"}), folder.path());
    Program odometry("gvom-odometry", vehicle.arguments(), folder.path());
    for (Program* const program : {&fusion, &ingest, &odometry}) {
      CHECK(waits(*program));
      CHECK(program->runs());
      check_stops(*program, signal);
    }
  }
}

TEST_CASE("each stops well while nothing comes, the broker last") {
  const TemporaryFolder folder;
  const Vehicle vehicle = simulated(folder.path(), 0.2);
  for (const int signal : kSignals) {
    Graph graph(vehicle);
    graph.start_fusion();
    const auto odometry = graph.replay({"--rate", "max"});  // waits for the ingests
    CHECK(graph.fusion().says("fusing 2 lidars"));
    CHECK(waits(*odometry));
    check_stops(*odometry, signal);
    graph.start_ingest("front");
    graph.start_ingest("rear");
    CHECK(graph.ingest("front").says("front from"));
    CHECK(graph.ingest("rear").says("rear from"));
    graph.stop(signal);
  }
}

TEST_CASE("each stops well while it maps at the recorded pace") {
  const TemporaryFolder folder;
  const Vehicle vehicle = simulated(folder.path(), 1);
  for (const int signal : kSignals) {
    Graph graph(vehicle);
    graph.start_readers();
    const auto odometry = endless_replay(graph, "1");
    REQUIRE(has_mapped(folder.path(), graph));
    check_stops(graph.ingest("front"), signal);  // the others go on meanwhile
    check_stops(graph.fusion(), signal);
    check_stops(graph.ingest("rear"), signal);
    check_stops(*odometry, signal);
    check_stops(graph.roudi(), signal);
  }
}

TEST_CASE("each stops well in a lossless replay, also one that waits for another that is gone") {
  const TemporaryFolder folder;
  const Vehicle vehicle = simulated(folder.path(), 1);
  for (const int signal : kSignals) {
    Graph graph(vehicle);
    graph.start_readers();
    const auto odometry = endless_replay(graph, "max");
    REQUIRE(has_mapped(folder.path(), graph));
    check_stops(graph.fusion(), signal);
    std::this_thread::sleep_for(500ms);  // the ingests now wait for room at fusion, odometry for them
    check_stops(graph.ingest("front"), signal);
    check_stops(*odometry, signal);
    check_stops(graph.ingest("rear"), signal);
    check_stops(graph.roudi(), signal);
  }
}

TEST_CASE("gvom-snapshot and gvom-play stop well") {
  const TemporaryFolder folder;
  const Vehicle vehicle = simulated(folder.path(), 1);
  for (const int signal : kSignals) {
    Graph graph(vehicle);
    graph.start_readers();
    const auto odometry = endless_replay(graph, "1");
    const auto snapshot = graph.start("gvom-snapshot", {"--out", folder.path() + "/every", "--every", "0.5"});
    CHECK(snapshot->says("picture 1"));
    check_stops(*snapshot, signal);
    Program play("gvom-play", {"front.pcap", "--loop", "--port", "9"}, folder.path());
    CHECK(takes_signals(play.pid()));
    check_stops(play, signal);
    check_stops(*odometry, signal);
    graph.stop(signal);
  }
}

TEST_CASE("one signal ends who joins a broker that hangs") {
  const TemporaryFolder folder;
  Graph graph(simulated(folder.path(), 0.2));
  graph.roudi().send(SIGSTOP);  // who joins now waits for an answer
  const auto fusion = graph.start("gvom-fusion", {});
  CHECK(waits(*fusion));
  CHECK(fusion->runs());
  fusion->send(SIGTERM);
  CHECK(fusion->wait(30s) == 0);  // iceoryx itself would wait for a minute
  graph.roudi().send(SIGCONT);
  graph.stop();
}

TEST_CASE("who was asked to stop ends with 0, wherever in its start the broker's end meets it") {
  const TemporaryFolder folder;
  Vehicle vehicle = simulated(folder.path(), 0.2);
  vehicle.sets.insert(vehicle.sets.end(),
                      {"map.size_xy=64", "map.size_z=8"});  // twenty brokers clear their pools
  for (int late_ms = 0; late_ms < 60; late_ms += 3) {
    INFO("after " << late_ms << " ms");
    Graph graph(vehicle);
    const auto fusion = graph.start("gvom-fusion", {});
    const auto ingest = graph.start("gvom-ingest", {"--lidar", "front"});
    REQUIRE(takes_signals(fusion->pid()));
    REQUIRE(takes_signals(ingest->pid()));
    std::this_thread::sleep_for(std::chrono::milliseconds(late_ms));
    fusion->send(SIGTERM);
    ingest->send(SIGTERM);
    graph.roudi().kill();
    CHECK(fusion->wait() == 0);
    INFO(fusion->output());
    CHECK(ingest->wait() == 0);
    INFO(ingest->output());
  }
}

TEST_CASE("one signal ends who leaves a broker that hangs, or that ends at the same moment") {
  const TemporaryFolder folder;
  const Vehicle vehicle = simulated(folder.path(), 0.2);
  for (const bool hangs : {true, false}) {
    Graph graph(vehicle);
    graph.start_readers();
    // Who still joins as the broker ends, ends with 70.
    REQUIRE(have_joined(folder.path(), {"gvom-fusion", "gvom-ingest-front", "gvom-ingest-rear"}));
    graph.roudi().send(hangs ? SIGSTOP : SIGTERM);
    for (Program* const program : {&graph.fusion(), &graph.ingest("front"), &graph.ingest("rear")})
      program->send(SIGTERM);
    for (Program* const program : {&graph.fusion(), &graph.ingest("front"), &graph.ingest("rear")}) {
      CHECK(program->wait() == 0);
      INFO(program->output());
      CHECK(program->output().size() < 4000);  // nobody repeats a complaint
    }
    graph.roudi().send(SIGCONT);
    if (!hangs) CHECK(graph.roudi().wait() == 0);  // a second signal would end it at once
    graph.stop();
  }
}
