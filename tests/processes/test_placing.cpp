// Which sweeps odometry can place: gvom-map, a replay and live packets give the same answer and the same
// bytes.
#include <catch2/catch.hpp>

#include <cmath>
#include <fstream>

#include "tests/ingest/ouster_builder.hpp"
#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using gvom::ipc::test::eventually;
using namespace std::chrono_literals;

namespace {

constexpr int kFrames = 16;  // fusion's queue holds as many: at any rate none is lost
/// Of looking_down(), whose seam lies in a sector of sky here.
constexpr int kColumns = 64;  // a millisecond each, then 36 ms of nothing
constexpr int kFirstReturn = 8;
constexpr int kLastReturn = 47;  // what is beside them is sky

/// The capture's clock is `capture_ahead_ns` ahead of the sensor's; some packets come a little late.
void write_recording(const std::string& folder, std::int64_t capture_ahead_ns = 0) {
  write_text(folder + "/meta.json", looking_down().json());
  PcapWriter pcap(folder + "/sky.pcap");
  for (int frame_id = 0; frame_id < kFrames; ++frame_id)
    for (int first = 0; first < kColumns; first += 4) {
      const bool sky = first < kFirstReturn || first > kLastReturn;
      pcap.add(frame(plain_packet(looking_down(), frame_id, first, sky ? 0 : 8000)),
               column_time_ns(frame_id, first + 3) + capture_ahead_ns + first % 3 * 200'000);
    }
  pcap.write();
}

struct Drive {
  double first_s = 1.0;
  double period_s = 0.05;
  double last_s = 2.6;
  double gap_from_s = 1e9;  // no pose after it, and before gap_to_s
  double gap_to_s = 1e9;
  double jump_at_s = 1e9;  // from here on 5 m further
};

/// At 2 m/s along x.
void write_odometry(const std::string& path, const Drive& drive) {
  std::ofstream file(path);
  for (int i = 0;; ++i) {
    const double t = drive.first_s + i * drive.period_s;
    if (t > drive.last_s + 1e-6) return;
    if (t > drive.gap_from_s && t < drive.gap_to_s) continue;
    char line[128];
    std::snprintf(line, sizeof line, "%.6f %.6f 0 0 0 0 0 1\n", t,
                  2 * i * drive.period_s + (t >= drive.jump_at_s ? 5 : 0));
    file << line;
  }
}

Vehicle vehicle_of(const std::string& folder, const std::string& source,
                   const std::string& clock = "sensor") {
  const std::string file = folder + "/vehicle.yaml";
  std::ofstream(file)
      << "name: sky\nodometry: {source: tum:odometry.tum, timeout_s: 10, max_clock_offset_s: 60}\n"
      << "lidars:\n  top:\n    source: '" << source << "'\n    max_returns: 4096\n"
      << "    clock: " << clock << "\n"
      << "    T_base_sensor: {x: 0, y: 0, z: 1.5, roll: 0, pitch: 0, yaw: 0}\n";
  return {file, {"top"}, folder, small_map()};
}

/// What a run mapped, and the words with which it told of the rest.
struct Run {
  std::string map;
  int maps = 0;
  std::string output;
};

Run replay(const Vehicle& vehicle, const std::string& rate) {
  const std::string pictures = vehicle.folder + "/pictures-" + rate;
  Graph graph(vehicle);
  graph.start_readers();
  const auto snapshot = graph.start("gvom-snapshot", {"--out", pictures, "--final", "--npy"});
  graph.play_through(rate);
  CHECK(snapshot->stop() == 0);
  graph.stop();
  const std::string output = graph.ingest("top").output();
  const auto numbers = numbers_before(output, "sweeps mapped");
  INFO(output);
  REQUIRE(numbers.size() == 2);
  CHECK(numbers[1] == kFrames);
  return {last_map(pictures), numbers[0], output};
}

/// gvom-map and a replay at both kinds of rate map so many sweeps, to the same bytes.
std::string check_same(const std::string& folder, const Drive& drive, int expected,
                       const std::string& clock = "sensor") {
  write_odometry(folder + "/odometry.tum", drive);
  const Vehicle vehicle = vehicle_of(folder, "ouster:sky.pcap?meta=meta.json", clock);
  const std::string maps = map_offline(vehicle, "maps");
  CHECK(map_count(maps) == expected);
  std::string told;
  for (const char* rate : {"10", "max"}) {
    INFO("--rate " << rate);
    const Run run = replay(vehicle, rate);
    CHECK(run.maps == expected);
    CHECK(differences(last_map(maps), run.map) == "");
    told = run.output;
  }
  return told;
}

}  // namespace

TEST_CASE("columns without a return need no odometry: all sweeps with sky at the seam are mapped") {
  const TemporaryFolder folder;
  write_recording(folder.path());
  Drive drive;
  drive.first_s = 1.005;  // after the first columns of the first sweep
  drive.last_s = 2.555;   // between the last return of the last sweep and its last column
  check_same(folder.path(), drive, kFrames);

  const std::string expected = last_map(folder.path() + "/maps");
  const std::uint16_t port = free_port();
  Graph graph(vehicle_of(folder.path(), "ouster-udp:" + std::to_string(port) + "?meta=meta.json"));
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_readers();
  const auto snapshot = graph.start("gvom-snapshot", {"--out", folder.path() + "/live", "--final", "--npy"});
  REQUIRE(graph.ingest("top").says("top from"));
  // The sweeps wait for their odometry: a slow ingest loses none.
  Program play("gvom-play", {"sky.pcap", "--port", std::to_string(port)}, folder.path());
  CHECK(play.wait() == 0);
  CHECK(graph.replay({"--rate", "1"})->wait() == 0);
  CHECK(eventually([&] { return observer.counter("gvom-ingest-top", "sweeps_mapped") == kFrames; }));
  CHECK(snapshot->stop() == 0);
  CHECK(differences(expected, last_map(folder.path() + "/live")) == "");
  graph.stop();
}

TEST_CASE("a sensor that counts from its boot is mapped by the arrival of its packets, the same everywhere") {
  const TemporaryFolder folder;
  constexpr double kUnix_s = 1'700'000'000;
  write_recording(folder.path(), 1'700'000'000'000'000'000);
  Drive drive;
  drive.first_s += kUnix_s;
  drive.last_s += kUnix_s;
  check_same(folder.path(), drive, kFrames, "arrival");
}

TEST_CASE("a gap and a jump of recorded odometry mean the same in one process and in several") {
  const TemporaryFolder folder;
  write_recording(folder.path());
  Drive gap;
  gap.gap_from_s = 1.49;
  gap.gap_to_s = 2.11;  // 1.45 .. 2.15 s: sweeps from 1.5 to 2.1 s
  CHECK_THAT(check_same(folder.path(), gap, kFrames - 7),
             Catch::Contains("7 sweeps not mapped: in a gap of the odometry (odometry.max_gap_s is 0.5)"));
  Drive jump;
  jump.jump_at_s = 1.52;  // between 1.50 and 1.55 s: across the sweep from 1.508 to 1.547 s
  CHECK_THAT(check_same(folder.path(), jump, kFrames - 1),
             Catch::Contains("1 sweeps not mapped: across a jump of the odometry"));
}

TEST_CASE("recordings whose clocks never meet: Health, the log and gvom-map name both spans and the guess") {
  const TemporaryFolder folder;
  write_recording(folder.path());
  Drive tai;
  tai.first_s = 1 + 37;
  tai.last_s += 37;
  write_odometry(folder.path() + "/odometry.tum", tai);
  const Vehicle vehicle = vehicle_of(folder.path(), "ouster:sky.pcap?meta=meta.json");
  const std::string words =
      "16 sweeps not mapped: before the odometry: odometry spans 38.0 .. 39.6 s, sweeps 1.0 .. 2.5 s "
      "(that is TAI - UTC)";
  const Ended offline = run("gvom-map", vehicle.arguments({"--out", "maps"}), folder.path());
  CHECK(offline.code == 65);
  CHECK_THAT(offline.output, Catch::Contains(words));

  Graph graph(vehicle);
  const Observer observer(folder.path());
  REQUIRE(observer.is_up());
  graph.start_readers();
  const auto odometry = graph.replay({"--rate", "1"});
  CHECK(eventually([&] {
    const auto health = observer.health("gvom-ingest-top");
    return health && health->state == static_cast<std::uint32_t>(gvom::ipc::HealthState::degraded) &&
           std::string(health->reason).find("16 sweeps not mapped: before the odometry") == 0;
  }));
  CHECK(odometry->wait() == 0);
  graph.stop();
  CHECK_THAT(graph.ingest("top").output(), Catch::Contains(words));
}
