// Which back end runs is asked for, told, and never changed in silence; a device that fails ends its process.
#include <catch2/catch.hpp>

#include <cstdlib>
#include <optional>

#include "core/open_backend.hpp"
#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/processes/replays.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using Catch::Contains;
using gvom::ipc::HealthState;
using gvom::ipc::test::eventually;
using Words = std::vector<std::string>;

namespace {

constexpr int kUnavailable = 69;
constexpr int kTryAgain = 75;

Vehicle with(Vehicle vehicle, const Words& sets, const std::string& variant = "") {
  vehicle.sets.insert(vehicle.sets.end(), sets.begin(), sets.end());
  vehicle.variant = variant;
  return vehicle;
}

/// Why there is no GPU, in the words of the library that the real programs link; nothing if there is one.
std::optional<std::string> why_no_gpu() {
  const auto opened = gvom::open_voxelizer(gvom::Backend::cuda, {{}, {}, {}, 1, {}});
  if (opened) return std::nullopt;
  return opened.error().what;
}

void check_says(const Observer& observer, const std::string& process, const std::string& words) {
  eventually([&] { return !observer.backend(process).empty(); });
  INFO(process);
  CHECK_THAT(observer.backend(process), Catch::StartsWith(words));
}

/// While one lives, programs on the fake device lose it at that operation.
class Fault {
 public:
  explicit Fault(int operation) { ::setenv(kName, std::to_string(operation).c_str(), 1); }
  ~Fault() { ::unsetenv(kName); }
  Fault(const Fault&) = delete;
  Fault& operator=(const Fault&) = delete;

 private:
  static constexpr const char* kName = "GVOM_SERIAL_DEVICE_FAIL_AT";
};

constexpr int kInFlight = 400;  // past the first ticks of ingest and fusion, long before the recording's end

void check_gave_up(Program& program, const std::string& name) {
  const int code = program.wait();
  INFO(program.output());
  CHECK(code == kTryAgain);
  CHECK_THAT(
      program.output(),
      Contains(name + " critical: cudaStreamSynchronize: an illegal memory access was encountered: leaving"));
}

}  // namespace

TEST_CASE("a drive ends in the CPU's bytes when every process computes on a device") {
  const TemporaryFolder folder;
  const Vehicle on_cpu = with(simulated(folder.path(), 1),
                              {"fusion.backend=cpu", "lidars.front.backend=cpu", "lidars.rear.backend=cpu"});
  const std::string expected = map_offline(on_cpu, "maps_cpu");
  const Vehicle on_device = with(
      on_cpu, {"fusion.backend=cuda", "lidars.front.backend=cuda", "lidars.rear.backend=cuda"}, "-serial");
  const std::string maps = map_offline(on_device, "maps_device");
  REQUIRE(map_count(maps) == map_count(expected));
  CHECK(differences(last_map(maps), last_map(expected)) == "");
  CHECK(voxels_of(last_map(maps)) == voxels_of(last_map(expected)));
  check_replay(on_device, "max", expected);
}

TEST_CASE("Health says which back end runs, on what, and how it reaches the memory") {
  const TemporaryFolder folder;
  simulated(folder.path(), 1);
  Graph graph(
      with(front_only(folder.path()), {"fusion.backend=auto", "lidars.front.backend=cuda"}, "-serial"));
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_readers();
  for (const char* process : {"gvom-fusion", "gvom-ingest-front"}) {
    check_says(observer, process, "cuda: fake device on the host");
    CHECK_THAT(observer.backend(process), Contains("maps by DMA"));
  }
  CHECK_THAT(graph.fusion().output(), Contains("fusing 1 lidars on cuda: fake device on the host"));
  graph.stop();
}

TEST_CASE("auto takes what there is and says why; cpu is as configured") {
  const TemporaryFolder folder;
  simulated(folder.path(), 1);
  Graph graph(with(front_only(folder.path()), {"fusion.backend=auto"}));
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_readers();
  const auto why = why_no_gpu();
  check_says(observer, "gvom-fusion", why ? ("cpu: no GPU: " + *why).substr(0, 100) : "cuda: ");
  check_says(observer, "gvom-ingest-front", "cpu: as configured");
  graph.stop();
}

TEST_CASE("an asked-for cuda without a GPU ends the start with 69 and the reason") {
  const auto why = why_no_gpu();
  if (!why) {
    WARN("SKIPPED: a GPU is here, so cuda starts");
    return;
  }
  const TemporaryFolder folder;
  simulated(folder.path(), 1);
  const Vehicle vehicle = with(front_only(folder.path()), {"fusion.backend=cuda"});
  Graph graph(vehicle);
  graph.start_fusion();
  CHECK(graph.fusion().wait() == kUnavailable);
  CHECK_THAT(graph.fusion().output(), Contains("error: fusion.backend cuda: " + *why));

  const auto ingest = graph.start("gvom-ingest", {"--lidar", "front", "--set", "lidars.front.backend=cuda"});
  CHECK(ingest->wait() == kUnavailable);
  CHECK_THAT(ingest->output(), Contains("error: lidars.front.backend cuda: " + *why));

  const Ended mapped = run("gvom-map", vehicle.arguments({"--out", "maps"}), folder.path());
  CHECK(mapped.code == kUnavailable);
  CHECK_THAT(mapped.output, Contains("error: fusion.backend cuda: " + *why));
  const Ended on_cpu =
      run("gvom-map", vehicle.arguments({"--out", "maps", "--backend", "cpu"}), folder.path());
  INFO(on_cpu.output);
  CHECK(on_cpu.code == 0);
  CHECK(graph.roudi().stop() == 0);
}

TEST_CASE("a device that fails in flight ends fusion, and no layers come of it") {
  const TemporaryFolder folder;
  simulated(folder.path(), 4);
  const Vehicle vehicle = with(front_only(folder.path()), {"fusion.backend=cuda"}, "-serial");
  const std::string expected = map_offline(vehicle, "maps");
  Graph graph(vehicle);
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  const std::string pictures = folder.path() + "/pictures";
  const auto snapshot = graph.start("gvom-snapshot", {"--out", pictures, "--final", "--npy"});
  {
    const Fault fault(kInFlight);
    graph.start_readers();
  }
  const auto odometry = graph.replay({"--rate", "max"});
  check_gave_up(graph.fusion(), "gvom-fusion");
  CHECK(observer.sees("gvom-fusion", HealthState::failed));
  const auto published = numbers_before(graph.fusion().output(), "layers published");
  REQUIRE(published.size() == 1);
  REQUIRE(published[0] > 0);
  REQUIRE(published[0] < map_count(expected));
  const auto newest = [&] { return observer.newest_layers().header; };
  CHECK(eventually([&] { return newest().sequence == static_cast<std::uint64_t>(published[0]); }));
  const std::int64_t last_ns = newest().stamp_ns;
  CHECK(snapshot->stop() == 0);
  CHECK(differences(map_of(expected, published[0] - 1), last_map(pictures)) == "");

  graph.start_fusion();  // as its supervisor would
  CHECK(odometry->wait() == 0);
  CHECK(eventually([&] { return newest().stamp_ns > last_ns; }));
  graph.stop();
}

TEST_CASE("a device that fails in flight ends ingest, and no map comes of it") {
  const TemporaryFolder folder;
  simulated(folder.path(), 4);
  Graph graph(
      with(front_only(folder.path()), {"fusion.backend=cpu", "lidars.front.backend=cuda"}, "-serial"));
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  {
    const Fault fault(kInFlight);
    graph.start_readers();
  }
  const auto odometry = graph.replay({"--rate", "max"});
  check_gave_up(graph.ingest("front"), "gvom-ingest-front");
  CHECK(observer.sees("gvom-ingest-front", HealthState::failed));
  CHECK(observer.counter("gvom-ingest-front", "drop_backend_failed") == 1);
  const auto mapped = numbers_before(graph.ingest("front").output(), "sweeps mapped");
  REQUIRE(mapped.size() == 2);
  REQUIRE(mapped[0] > 0);
  CHECK(odometry->stop() == 0);
  CHECK(eventually([&] {
    return observer.counter("gvom-fusion", "maps_fused") == static_cast<std::uint64_t>(mapped[0]);
  }));
  CHECK(graph.fusion().stop() == 0);
  CHECK(numbers_before(graph.fusion().output(), "maps fused") == std::vector<int>{mapped[0]});
  CHECK(graph.roudi().stop() == 0);
}

TEST_CASE("a device that fails in flight ends gvom-map with 69 and the reason") {
  const TemporaryFolder folder;
  simulated(folder.path(), 4);
  const Vehicle vehicle = front_only(folder.path());
  const Fault fault(kInFlight);
  const Ended mapped =
      run("gvom-map-serial", vehicle.arguments({"--out", "maps", "--backend", "cuda"}), folder.path());
  INFO(mapped.output);
  CHECK(mapped.code == kUnavailable);
  CHECK_THAT(mapped.output, Contains("an illegal memory access was encountered"));
  CHECK(map_count(folder.path() + "/maps") > 0);
}
