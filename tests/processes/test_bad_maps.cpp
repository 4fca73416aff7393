// Maps that are readable but lead nowhere, or lie about their time: fusion believes nothing of them, counts
// them by what is wrong, says whose they are, and maps the good lidar as if it were alone.
#include <sys/mman.h>

#include <catch2/catch.hpp>

#include <cmath>
#include <fstream>
#include <sstream>

#include "ipc/text.hpp"
#include "services/common/bus/pool_spec.hpp"
#include "services/common/config_file.hpp"
#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using gvom::ipc::BrickMapPublisher;
using gvom::ipc::BrickMapSample;
using gvom::ipc::BrickMapSubscriber;
using gvom::ipc::BrickMapWriter;
using gvom::ipc::test::Child;
using gvom::ipc::test::eventually;
using gvom::ipc::test::Step;
using namespace std::chrono_literals;

namespace {

constexpr int kSweeps = 20;
constexpr char kFusion[] = "gvom-fusion";
constexpr const char* kCounters[] = {
    "drop_map_bad_directory", "drop_map_bad_lookup", "drop_map_bad_columns", "drop_map_bad_lowest_rays",
    "drop_map_bad_records",   "drop_map_bad_epoch",  "drop_map_bad_time"};
constexpr std::int64_t kFar_ns = 3'000'000'000'000'000'000;  // the year 2065
constexpr std::uint64_t kLastEpoch = ~std::uint64_t{0};

/// What a lie changes of a map that is else as good as the original.
struct Claim {
  std::uint64_t epoch;
  std::int64_t stamp_ns;
  std::int64_t jump_ns;
};

/// Each would make all maps of the good lidar too old for good.
Claim lie_of(int number, const gvom::ipc::MessageHeader& header) {
  switch (number) {
    case 0:
      return {kLastEpoch, header.stamp_ns, 0};
    case 1:
      return {kLastEpoch, kFar_ns, kFar_ns};
    case 2:
      return {header.epoch, header.stamp_ns, kFar_ns};
    default:
      return {header.epoch, kFar_ns, kFar_ns};
  }
}

/// Makes the map lead nowhere, in a way that the counter of this index counts.
void spoil(const BrickMapWriter& map, std::size_t counter) {
  const auto brick_count = static_cast<std::int32_t>(map.header().shape.brick_count);
  switch (counter) {
    case 0:
      for (auto& brick : map.directory()) brick = brick < 0 ? brick : brick_count + 1'000'000;
      break;
    case 1:
      for (auto& record : map.lookup()) record = record < 0 ? record : record + 1'000'000'000;
      break;
    case 2:
      map.columns()[0] ^= 1;
      break;
    case 3:
      map.lowest_ray_m()[0] = NAN;
      break;
    default:
      map.records()[0].min_height_m = NAN;
  }
}

BrickMapWriter copy_of(const BrickMapSample& map, BrickMapPublisher& publisher) {
  const gvom::ipc::BrickMap& header = map.header();
  auto copy = publisher.loan(header.shape);
  EXPECT(copy);
  copy->header() = header;
  gvom::ipc::set_text(copy->header().lidar, "rear");
  std::copy(map.directory().begin(), map.directory().end(), copy->directory().begin());
  std::copy(map.lookup().begin(), map.lookup().end(), copy->lookup().begin());
  std::copy(map.columns().begin(), map.columns().end(), copy->columns().begin());
  std::copy(map.lowest_ray_m().begin(), map.lowest_ray_m().end(), copy->lowest_ray_m().begin());
  std::copy(map.records().begin(), map.records().end(), copy->records().begin());
  return std::move(*copy);
}

/// Publishes each map of `front` as one of `rear` with something wrong: its arrays, half of them of a later
/// epoch, or what it says of its time.
[[noreturn]] void live_as_liar(const Vehicle& vehicle, Step& lies) {
  const auto config = gvom::services::load_vehicle_config(vehicle.file, vehicle.sets).value();
  auto runtime = gvom::ipc::Runtime::connect("gvom-ingest-rear", gvom::ipc::test::kPatience).value();
  auto maps = BrickMapSubscriber::buffer_map(runtime, "front").value();
  auto liar =
      BrickMapPublisher::buffer_map(runtime, "rear", buffer_map_capacity(gvom::services::pool_spec(config)))
          .value();
  EXPECT(eventually([&] { return liar.has_subscribers(); }));
  lies.reach(1);
  for (int sent = 0;; ++sent) {
    auto map = maps.take();
    while (!map) {
      std::this_thread::sleep_for(1ms);
      map = maps.take();
    }
    BrickMapWriter copy = copy_of(*map, liar);
    const auto& header = map->header().header;
    const int kind = sent % 9;
    Claim claim{header.epoch + (sent / 9 % 2 == 0 ? 0 : 7), header.stamp_ns, 0};
    if (kind < 5)
      spoil(copy, static_cast<std::size_t>(kind));
    else
      claim = lie_of(kind - 5, header);
    copy.header().odometry_jump_ns = claim.jump_ns;
    liar.publish(std::move(copy), claim.stamp_ns, claim.epoch);
  }
}

/// The vehicle of one lidar and another beside it, whose ingest is not started.
Vehicle with_rear(const Vehicle& front) {
  Vehicle vehicle = front;
  vehicle.file = front.folder + "/with_rear.yaml";
  std::ostringstream text;
  text << std::ifstream(front.file).rdbuf();
  std::ofstream(vehicle.file) << text.str()
                              << "  rear:\n    source: ouster:front.pcap?meta=front.json\n"
                                 "    max_returns: 65536\n"
                                 "    T_base_sensor: {x: 0, y: 0, z: 1, roll: 0, pitch: 0, yaw: 3}\n";
  return vehicle;
}

void check_bad_maps(const std::vector<std::string>& sets, const std::string& variant) {
  const TemporaryFolder folder;
  simulated(folder.path(), kSweeps / 10.0);
  Vehicle front = front_only(folder.path());
  const std::string expected = last_map(map_offline(front, "maps"));
  Vehicle vehicle = with_rear(front);
  vehicle.sets.insert(vehicle.sets.end(), sets.begin(), sets.end());
  vehicle.variant = variant;

  Graph graph(vehicle);
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_readers();
  REQUIRE(graph.ingest("front").says("front from"));
  REQUIRE(graph.fusion().says("fusing"));
  const std::string out = folder.path() + "/out";
  const auto snapshot = graph.start("gvom-snapshot", {"--out", out, "--final", "--npy"});
  Step lies;
  Child liar([&] { live_as_liar(graph.vehicle(), lies); });
  REQUIRE(lies.wait_for(1));

  // Lossless for the lidar that there is: nothing waits for the liar, who sends as much as he gets to see.
  Program odometry("gvom-odometry", front.arguments({"--rate", "max"}), folder.path());
  CHECK(odometry.wait() == 0);
  CHECK(eventually([&] { return observer.has_said(kFusion, "lidar rear: map refused: "); }));
  CHECK(eventually([&] { return observer.counter(kFusion, "maps_fused") == kSweeps; }));
  const auto refused = [&] {
    std::uint64_t sum = 0;
    for (const char* counter : kCounters) sum += observer.counter(kFusion, counter);
    return sum;
  };
  CHECK(eventually([&] { return observer.counter(kFusion, "maps_in") == kSweeps + refused(); }));
  for (const char* counter : kCounters) {
    INFO(counter);
    CHECK(observer.counter(kFusion, counter) > 0);
  }
  CHECK(graph.fusion().runs());
  CHECK(observer.counter(kFusion, "epochs") == 0);
  CHECK(observer.newest_layers().lidars[1].missing == 1);
  CHECK(observer.newest_layers().lidars[1].newest_stamp_ns == 0);  // nothing of them is believed
  CHECK(snapshot->stop() == 0);
  CHECK(differences(expected, last_map(out)) == "");
  liar.kill();
  graph.stop();
}

}  // namespace

TEST_CASE(
    "maps that lead nowhere or lie about their time are refused, and the good lidar's are mapped as if "
    "alone") {
  check_bad_maps({"fusion.backend=cpu"}, "");
}

TEST_CASE("so they are where a device fuses") {
  check_bad_maps({"fusion.backend=cuda", "lidars.front.backend=cpu"}, "-serial");
}
