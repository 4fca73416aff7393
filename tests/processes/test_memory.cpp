// Ingest and fusion take no more memory after a thousand sweeps than after the first.
#include <catch2/catch.hpp>

#include <fstream>

#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using gvom::ipc::test::eventually;
using namespace std::chrono_literals;

namespace {

constexpr std::uint64_t kWarmUp = 100;  // sweeps
constexpr std::uint64_t kSweeps = 1000;
constexpr long kMostGrowth_kb = 256;

/// Memory of the process's own (not files, not shared), kB.
long anonymous_kb(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  std::string word;
  long value_kb = -1;
  while (status >> word)
    if (word == "RssAnon:") status >> value_kb;
  return value_kb;
}

}  // namespace

TEST_CASE("the memory of ingest and fusion does not grow in a thousand sweeps") {
  const TemporaryFolder folder;
  simulated(folder.path(), 1);
  Graph graph(front_only(folder.path()));
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_readers();
  const auto odometry = graph.replay({"--rate", "max", "--loop"});
  const auto reach = [&](std::uint64_t sweeps) {
    return eventually([&] { return observer.counter("gvom-ingest-front", "sweeps_mapped") >= sweeps; }, 240s);
  };
  REQUIRE(reach(kWarmUp));
  const long ingest_kb = anonymous_kb(graph.ingest("front").pid());
  const long fusion_kb = anonymous_kb(graph.fusion().pid());
  REQUIRE(reach(observer.counter("gvom-ingest-front", "sweeps_mapped") + kSweeps));
  const long ingest_later_kb = anonymous_kb(graph.ingest("front").pid());
  const long fusion_later_kb = anonymous_kb(graph.fusion().pid());
  INFO("ingest: " << ingest_kb << " kB, then " << ingest_later_kb << "; fusion: " << fusion_kb << " kB, then "
                  << fusion_later_kb);
  CHECK(ingest_kb > 0);
  CHECK(fusion_kb > 0);
  CHECK(ingest_later_kb <= ingest_kb + kMostGrowth_kb);
  CHECK(fusion_later_kb <= fusion_kb + kMostGrowth_kb);
  CHECK(odometry->stop() == 0);
  CHECK(observer.counter("gvom-ingest-front", "drop_no_chunk") == 0);
  graph.stop();
}
