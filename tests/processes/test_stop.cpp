// SIGINT and SIGTERM end each process well, whatever it does at that moment.
#include <catch2/catch.hpp>

#include <fstream>
#include <string>

#include "tests/ipc/processes.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using gvom::ipc::test::eventually;
using namespace std::chrono_literals;

namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM};

void check_stops(Program& program, int signal) {
  const int code = program.stop(signal, 20s);  // a picture takes its time on a busy machine
  INFO("signal " << signal << "\n" << program.output());
  CHECK(code == 0);
}

/// Whether its main has come so far that SIGTERM ends it no more by itself.
bool takes_signals(const Program& program) {
  std::ifstream status("/proc/" + std::to_string(program.pid()) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("SigBlk:", 0) == 0)
      return (std::stoull(line.substr(7), nullptr, 16) >> (SIGTERM - 1) & 1) != 0;
  return false;
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
    std::this_thread::sleep_for(300ms);
    for (Program* const program : {&fusion, &ingest, &odometry}) {
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
    std::this_thread::sleep_for(300ms);
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
    std::this_thread::sleep_for(300ms);
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
  std::this_thread::sleep_for(300ms);
  CHECK(fusion->runs());
  CHECK(fusion->stop(SIGTERM) == 0);  // iceoryx itself would wait for a minute
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
    REQUIRE(eventually([&] { return takes_signals(*fusion) && takes_signals(*ingest); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(late_ms));
    fusion->send(SIGTERM);
    ingest->send(SIGTERM);
    graph.roudi().kill();
    CHECK(fusion->wait(20s) == 0);
    INFO(fusion->output());
    CHECK(ingest->wait(20s) == 0);
    INFO(ingest->output());
  }
}

TEST_CASE("one signal ends who leaves a broker that hangs, or that ends at the same moment") {
  const TemporaryFolder folder;
  const Vehicle vehicle = simulated(folder.path(), 0.2);
  for (const bool hangs : {true, false}) {
    Graph graph(vehicle);
    graph.start_readers();
    CHECK(graph.fusion().says("fusing 2 lidars"));
    CHECK(graph.ingest("front").says("front from"));
    CHECK(graph.ingest("rear").says("rear from"));
    std::this_thread::sleep_for(
        500ms);  // they have joined with all that they publish; who still does ends with 70
    graph.roudi().send(hangs ? SIGSTOP : SIGTERM);
    for (Program* const program : {&graph.fusion(), &graph.ingest("front"), &graph.ingest("rear")})
      program->send(SIGTERM);
    for (Program* const program : {&graph.fusion(), &graph.ingest("front"), &graph.ingest("rear")}) {
      CHECK(program->wait(20s) == 0);
      INFO(program->output());
      CHECK(program->output().size() < 4000);  // nobody repeats a complaint
    }
    graph.roudi().send(SIGCONT);
    if (!hangs) CHECK(graph.roudi().wait(20s) == 0);  // a second signal would end it at once
    graph.stop();
  }
}
