// Bad input: said clearly, with the right exit code, and never at the cost of what was good.
#include <catch2/catch.hpp>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/ingest/ouster_builder.hpp"
#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using gvom::ipc::test::eventually;
using Words = std::vector<std::string>;
namespace fs = std::filesystem;
using namespace std::chrono_literals;

namespace {

constexpr int kUsage = 64;
constexpr int kBadData = 65;
constexpr int kUnavailable = 69;
constexpr int kTryAgain = 75;
constexpr int kConfiguration = 78;

void check_refused(const std::string& program, const Words& arguments, const std::string& folder, int code,
                   const Words& words) {
  const Ended ended = run(program, arguments, folder);
  INFO(program << " said: " << ended.output);
  CHECK(ended.code == code);
  for (const std::string& word : words) CHECK_THAT(ended.output, Catch::Contains(word));
}

/// A vehicle with the lidar `front` and a recording of a second: ten sweeps.
class Drive {
 public:
  Drive() : vehicle_(simulated(folder_.path(), 1)) { vehicle_ = front_only(folder_.path()); }

  [[nodiscard]] std::string path(const std::string& file) const { return folder_.path() + "/" + file; }
  [[nodiscard]] const std::string& folder() const { return folder_.path(); }
  [[nodiscard]] Vehicle with(const std::string& set) const {
    Vehicle vehicle = vehicle_;
    vehicle.sets.push_back(set);
    return vehicle;
  }
  [[nodiscard]] Words arguments(const Words& more) const { return vehicle_.arguments(more); }

  /// gvom-map and gvom-ingest refuse this source of the lidar.
  void check_source(const std::string& uri, const Words& words) const {
    const Vehicle vehicle = with("lidars.front.source=" + uri);
    check_refused("gvom-map", vehicle.arguments({"--out", path("maps")}), folder(), kBadData, words);
    check_refused("gvom-ingest", vehicle.arguments({"--lidar", "front"}), folder(), kBadData, words);
  }

  /// gvom-map and gvom-odometry refuse this odometry.
  void check_odometry(const std::string& text, const Words& words) const {
    write_text(path("bad.tum"), text);
    const Vehicle vehicle = with("odometry.source=tum:bad.tum");
    check_refused("gvom-map", vehicle.arguments({"--out", path("maps")}), folder(), kBadData, words);
    check_refused("gvom-odometry", vehicle.arguments(), folder(), kBadData, words);
  }

 private:
  TemporaryFolder folder_;
  Vehicle vehicle_;
};

/// Replays a source of which only the beginning is good; gvom-ingest ends by itself if `code` is not 0.
void check_good_part(const Vehicle& vehicle, int sweeps, int code, const std::string& words) {
  const std::string out = vehicle.folder + "/good_part";
  fs::remove_all(out);
  const Ended mapped = run("gvom-map", vehicle.arguments({"--out", out}), vehicle.folder);
  INFO(mapped.output);
  CHECK(mapped.code == code);
  CHECK_THAT(mapped.output, Catch::Contains(words));
  CHECK(map_count(out) == sweeps);

  Graph graph(vehicle);
  graph.start_readers();
  const auto odometry = graph.replay({"--rate", "4"});
  Program& ingest = graph.ingest("front");
  if (code == 0) CHECK(odometry->wait() == 0);
  CHECK((code == 0 ? ingest.stop() : ingest.wait()) == code);
  INFO(ingest.output());
  CHECK_THAT(ingest.output(), Catch::Contains(words));
  CHECK(numbers_before(ingest.output(), "sweeps mapped") == std::vector<int>{sweeps, sweeps});
  CHECK(odometry->stop() == 0);
  CHECK(graph.fusion().stop() == 0);
  CHECK(graph.roudi().stop() == 0);
}

}  // namespace

TEST_CASE("recordings that are not there or not what they should be") {
  const Drive drive;
  drive.check_source("ouster:none.pcap?meta=front.json", {"none.pcap", "No such file"});
  drive.check_source("ouster:front.pcap?meta=none.json", {"none.json"});
  drive.check_source("scans:" + drive.path("none"), {"/none", "no such file or folder"});
  drive.check_source("laser:front.pcap", {"laser", "unknown scheme"});

  write_text(drive.path("empty.pcap"), "");
  drive.check_source("ouster:empty.pcap?meta=front.json", {"empty.pcap"});
  PcapWriter(drive.path("header_only.pcap")).write();
  drive.check_source("ouster:header_only.pcap?meta=front.json", {"header_only.pcap", "no packets"});
  write_text(drive.path("text.pcap"), "this is not a capture, whatever its name says\n");
  drive.check_source("ouster:text.pcap?meta=front.json", {"text.pcap"});

  write_text(drive.path("other.json"), OusterSensor{}.json());
  drive.check_source("ouster:front.pcap?meta=other.json",
                     {"front.pcap", "no packet is of the sensor", "bytes"});
  write_text(drive.path("broken.json"), "{\"beam_altitude_angles\": [");
  drive.check_source("ouster:front.pcap?meta=broken.json", {"broken.json"});
}

TEST_CASE("odometry that is not there, holds NaNs or goes back in time") {
  const Drive drive;
  const std::string good = "1000.0 0 0 0 0 0 0 1\n";
  drive.check_odometry("# nothing\n", {"bad.tum", "no pose"});
  drive.check_odometry(good + "1000.1 nan 0 0 0 0 0 1\n", {"bad.tum:2", "nan", "finite"});
  drive.check_odometry(good + "999.9 0 0 0 0 0 0 1\n", {"bad.tum:2", "999.9", "time"});
  drive.check_odometry(good + "1000.1 0 0 0\n", {"bad.tum:2", "8 columns"});
  drive.check_odometry(good + "1000.1 0 0 0 0 0 0 0\n", {"bad.tum:2", "quaternion"});
  const Vehicle none = drive.with("odometry.source=tum:none.tum");
  check_refused("gvom-map", none.arguments({"--out", "m"}), drive.folder(), kBadData, {"none.tum"});
  check_refused("gvom-odometry", none.arguments(), drive.folder(), kBadData, {"none.tum", "No such file"});
}

TEST_CASE("a vehicle file with a misspelt key stops everybody, with file, line and key") {
  const Drive drive;
  write_text(drive.path("misspelt.yaml"),
             "name: misspelt\n"
             "map:\n"
             "  size_yx: 128\n"
             "lidars: {front: {T_base_sensor: {x: 0, y: 0, z: 2, roll: 0, pitch: 0, yaw: 0}}}\n");
  for (const char* program : {"gvom-roudi", "gvom-odometry", "gvom-ingest", "gvom-fusion", "gvom-map",
                              "gvom-snapshot", "gvom-sim"}) {
    Words arguments{"--config", drive.path("misspelt.yaml")};
    if (program == std::string("gvom-ingest")) arguments.insert(arguments.end(), {"--lidar", "front"});
    if (program == std::string("gvom-snapshot") || program == std::string("gvom-sim"))
      arguments.insert(arguments.end(), {"--out", drive.path("out")});
    check_refused(program, arguments, drive.folder(), kConfiguration, {"misspelt.yaml:3", "map.size_yx"});
  }
  check_refused("gvom-fusion", {"--config", drive.path("none.yaml")}, drive.folder(), kConfiguration,
                {"none.yaml"});
  check_refused("gvom-fusion", drive.arguments({"--set", "map.size_xy=100"}), drive.folder(), kConfiguration,
                {"map.size_xy", "100"});
}

TEST_CASE("a lidar that the vehicle does not have, and command lines that say nothing") {
  const Drive drive;
  check_refused("gvom-ingest", drive.arguments({"--lidar", "nope"}), drive.folder(), kConfiguration,
                {"nope", "front_only.yaml"});
  check_refused("gvom-map", drive.arguments({"--out", "m", "--source", "nope=scans:x"}), drive.folder(),
                kConfiguration, {"nope", "front_only.yaml"});
  check_refused("gvom-ingest", drive.arguments({"--lidar", "front", "--set", "lidars.front.source=''"}),
                drive.folder(), kConfiguration, {"lidars.front.source"});
  check_refused("gvom-map", drive.arguments({"--out", "m", "--source", "front"}), drive.folder(), kUsage,
                {"NAME=URI"});
  check_refused("gvom-map", drive.arguments({}), drive.folder(), kUsage, {"--out"});
  check_refused("gvom-odometry", drive.arguments({"--rate", "fast"}), drive.folder(), kUsage, {"--rate"});
  check_refused("gvom-fusion", drive.arguments({"--no-such-option"}), drive.folder(), kUsage,
                {"--no-such-option"});
  const Vehicle live = drive.with("lidars.front.source=ouster-udp:17502?meta=front.json");
  check_refused("gvom-map", live.arguments({"--out", "m"}), drive.folder(), kBadData, {"live"});
}

TEST_CASE("a port that another process has is not there yet: to be tried again") {
  const Drive drive;
  const int other = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  REQUIRE(::bind(other, reinterpret_cast<const sockaddr*>(&address), size) == 0);
  REQUIRE(::getsockname(other, reinterpret_cast<sockaddr*>(&address), &size) == 0);
  const std::string port = std::to_string(ntohs(address.sin_port));
  const Vehicle live = drive.with("lidars.front.source=ouster-udp:" + port + "?meta=front.json");
  check_refused("gvom-ingest", live.arguments({"--lidar", "front"}), drive.folder(), kUnavailable,
                {"UDP port " + port, "in use"});
  ::close(other);
}

TEST_CASE("a sweep can have more returns than max_returns: refused, with the number that is needed") {
  const Drive drive;
  const Vehicle small = drive.with("lidars.front.max_returns=65000");  // 64 beams, 1024 columns
  const Words words{"lidars.front.max_returns is 65000", "make it 65536"};
  check_refused("gvom-ingest", small.arguments({"--lidar", "front"}), drive.folder(), kConfiguration, words);
  check_refused("gvom-map", small.arguments({"--out", "m"}), drive.folder(), kBadData, words);
}

TEST_CASE("folders that cannot be written") {
  const Drive drive;
  write_text(drive.path("file"), "");
  const Words out{"--out", drive.path("file/folder")};
  check_refused("gvom-map", drive.arguments(out), drive.folder(), kUnavailable, {"file/folder"});
  check_refused("gvom-snapshot", drive.arguments(out), drive.folder(), kUnavailable, {"file/folder"});
}

TEST_CASE("without a broker they wait, and then say so") {
  const Drive drive;
  Program fusion("gvom-fusion", drive.arguments({}), drive.folder());
  Program ingest("gvom-ingest", drive.arguments({"--lidar", "front"}), drive.folder());
  Program odometry("gvom-odometry", drive.arguments({}), drive.folder());
  Program snapshot("gvom-snapshot", drive.arguments({"--out", "o", "--timeout", "0.5"}), drive.folder());
  CHECK(snapshot.wait() == kTryAgain);
  for (Program* const program : {&fusion, &ingest, &odometry}) {
    CHECK(program->wait() == kUnavailable);
    CHECK_THAT(program->output(), Catch::Contains("is gvom-roudi running?"));
  }
}

TEST_CASE("a grid whose chunks do not fit a pool") {
  const Drive drive;
  check_refused("gvom-roudi", drive.arguments({"--set", "map.size_xy=1024", "--set", "map.size_z=256"}),
                drive.folder(), kConfiguration, {"map.size_xy", "4 GiB", "front_only.yaml"});
}

TEST_CASE("a process of another configuration than the broker's says so and goes on") {
  const Drive drive;
  Graph graph(drive.with("name=small"));
  const Observer observer(drive.folder());
  REQUIRE(observer.is_up());
  graph.start_fusion();
  const Vehicle large = drive.with("map.size_xy=512");
  Program ingest("gvom-ingest", large.arguments({"--lidar", "front"}), drive.folder());
  const auto odometry = graph.replay({"--rate", "1"});
  CHECK(ingest.says("was it started with another configuration?"));
  CHECK(odometry->wait() == 0);
  CHECK(ingest.stop() == 0);
  CHECK(eventually([&] { return observer.counter("gvom-ingest-front", "drop_no_chunk") == 10; }));
  graph.stop();
}

TEST_CASE("of a pcap that is cut off the sweeps before are mapped") {
  const Drive drive;
  fs::copy_file(drive.path("front.pcap"), drive.path("cut.pcap"));
  fs::resize_file(drive.path("cut.pcap"), fs::file_size(drive.path("cut.pcap")) * 42 / 100);
  check_good_part(drive.with("lidars.front.source=ouster:cut.pcap?meta=front.json"), 4, 0,
                  "cut off by the end of the file");
}

TEST_CASE("of a pcap with a corrupt record the sweeps before are mapped") {
  const Drive drive;
  fs::copy_file(drive.path("front.pcap"), drive.path("corrupt.pcap"));
  std::fstream file(drive.path("corrupt.pcap"), std::ios::in | std::ios::out | std::ios::binary);
  const auto record = static_cast<std::streamoff>((fs::file_size(drive.path("front.pcap")) - 24) / 640);
  file.seekp(24 + record * (64 * 4 + 16) + 8);  // the lengths of a record early in the fifth sweep
  file.write("\xFF\xFF\xFF\x7F\xFF\xFF\xFF\x7F", 8);
  file.close();
  check_good_part(drive.with("lidars.front.source=ouster:corrupt.pcap?meta=front.json"), 4, kBadData,
                  "corrupt.pcap");
}

TEST_CASE("of scans with one of an impossible size those before are mapped") {
  const Drive drive;
  const std::string scans = scans_of_simulated(drive.folder());
  fs::resize_file(scans + "/100003.bin", fs::file_size(scans + "/100003.bin") - 3);
  check_good_part(drive.with("lidars.front.source=scans:" + scans), 3, kBadData, "100003.bin");
}

TEST_CASE("gvom-drive in real time takes nothing that is of many drives") {
  const TemporaryFolder folder;
  const std::string rows = folder.path() + "/rows.csv";
  for (const Words& more :
       {Words{"--rows", rows}, Words{"--ablation", "deskew-off"}, Words{"--course", "test-1", "--figures"}}) {
    Words arguments{"--config", GVOM_SOURCE_DIR "/config/vehicles/warthog.yaml", "--real-time", "--out",
                    folder.path() + "/out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    check_refused("gvom-drive", arguments, folder.path(), kUsage, {"--real-time drives one world as it is"});
  }
  CHECK_FALSE(fs::exists(rows));
}
