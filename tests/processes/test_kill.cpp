// What the others do when one process is killed, and when it comes back.
#include <catch2/catch.hpp>

#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using gvom::ipc::test::eventually;
using namespace std::chrono_literals;

namespace {

constexpr int kRounds = 20;

/// True when so many more layers came.
bool layers_flow(const Observer& observer, std::uint64_t more = 3) {
  const std::uint64_t before = observer.layers();
  return eventually([&] { return observer.layers() >= before + more; });
}

/// Whether the window has maps of the vehicle's first lidar (front).
bool front_is_there(const Observer& observer) {
  return observer.newest_layers().lidars[0].missing == 0;
}

}  // namespace

TEST_CASE("a killed ingest or fusion comes back, the others go on, and no chunk is lost") {
  const TemporaryFolder folder;
  Vehicle vehicle = simulated(folder.path(), 6);
  vehicle.sets.push_back("window.max_age_s=0.5");
  Graph graph(vehicle);
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_readers();
  graph.play_through("4");
  const auto before = observer.used_chunks();  // nothing flows
  REQUIRE(!before.empty());

  auto odometry = graph.replay({"--rate", "2", "--loop"});
  REQUIRE(layers_flow(observer));
  for (int round = 0; round < kRounds; ++round) {
    INFO("round " << round);
    const bool kill_fusion = round % 2 == 1;
    if (kill_fusion) {
      CHECK(graph.fusion().kill_asleep() == 128 + SIGKILL);
      graph.start_fusion();
    } else {
      CHECK(graph.ingest("front").kill_asleep() == 128 + SIGKILL);
      REQUIRE(eventually([&] { return !front_is_there(observer); }));
      REQUIRE(layers_flow(observer));
      graph.start_ingest("front");
    }
    REQUIRE(eventually([&] { return front_is_there(observer); }));
    REQUIRE(layers_flow(observer));
  }
  CHECK(odometry->stop() == 0);

  graph.play_through("4");
  const auto after = observer.used_chunks();
  REQUIRE(after.size() == before.size());
  for (std::size_t pool = 0; pool < after.size(); ++pool) {
    INFO("pool " << pool << ": " << before[pool] << " chunks in use before, " << after[pool] << " after");
    CHECK(after[pool] <= before[pool] + 2);
  }
  // Not all drops: on a busy machine a map may come after its window's time, or after its epoch.
  CHECK(observer.counter("gvom-fusion", "drop_layers_no_chunk") == 0);
  CHECK(observer.counter("gvom-ingest-front", "drop_no_chunk") == 0);
  CHECK(observer.counter("gvom-ingest-rear", "drop_no_chunk") == 0);
  graph.stop();
}

TEST_CASE("a fusion or an ingest that is killed in a lossless replay does not hold it up") {
  const TemporaryFolder folder;
  Graph graph(simulated(folder.path(), 1));
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_readers();
  const auto odometry = graph.replay({"--rate", "max", "--loop"});
  REQUIRE(layers_flow(observer));
  // At this pace somebody always publishes: the replay holds its breath while one dies.
  const auto replace = [&](Program& program, const auto& start_anew) {
    odometry->send(SIGSTOP);
    for (std::uint64_t before = observer.layers() + 1; before != observer.layers();) {
      before = observer.layers();
      std::this_thread::sleep_for(200ms);
    }
    CHECK(program.kill_asleep() == 128 + SIGKILL);
    start_anew();
    odometry->send(SIGCONT);
    REQUIRE(layers_flow(observer, 50));
  };
  for (int round = 0; round < 3; ++round) {
    INFO("round " << round);
    replace(graph.fusion(), [&] { graph.start_fusion(); });
    replace(graph.ingest("front"), [&] { graph.start_ingest("front"); });
  }
  CHECK(odometry->stop() == 0);
  graph.stop();
}

TEST_CASE("when the broker is killed everybody leaves, to be started again") {
  const TemporaryFolder folder;
  Graph graph(simulated(folder.path(), 1));
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_readers();
  const auto odometry = graph.replay({"--rate", "1", "--loop"});
  const auto snapshot = graph.start("gvom-snapshot", {"--out", folder.path() + "/out", "--every", "0.5"});
  REQUIRE(layers_flow(observer));
  REQUIRE(snapshot->says("picture 1"));
  graph.roudi().kill();
  for (Program* const program :
       {&graph.fusion(), &graph.ingest("front"), &graph.ingest("rear"), odometry.get(), snapshot.get()}) {
    const int code = program->wait(30s);
    INFO(program->output());
    CHECK(code == 75);
  }
}
