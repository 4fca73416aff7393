// gvomctl check on vehicle files that work, and on those that do not.
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using Catch::Matchers::Contains;

namespace {

/// A UDP port that this process holds.
class TakenPort {
 public:
  TakenPort() : fd_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    socklen_t size = sizeof address;
    REQUIRE(::bind(fd_, reinterpret_cast<sockaddr*>(&address), size) == 0);
    REQUIRE(::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
    port_ = std::to_string(ntohs(address.sin_port));
  }
  ~TakenPort() { give(); }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;

  void give() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  [[nodiscard]] const std::string& port() const { return port_; }

 private:
  int fd_;
  std::string port_;
};

/// The simulated vehicle beside its recording.
struct Checked {
  Checked() : vehicle(simulated(folder.path(), 0.5)) {}

  Ended check(const std::vector<std::string>& sets = {}) const {
    std::vector<std::string> arguments{"check", vehicle.file};
    for (const auto* list : {&vehicle.sets, &sets})
      for (const std::string& set : *list) arguments.insert(arguments.end(), {"--set", set});
    return run("gvomctl", arguments, folder.path());
  }

  TemporaryFolder folder;
  Vehicle vehicle;
};

}  // namespace

TEST_CASE("check: a vehicle that works has no error, in words and in JSON") {
  const Checked checked;
  const Ended ended = checked.check();
  INFO(ended.output);
  CHECK(ended.code == 0);
  CHECK_THAT(ended.output,
             Contains("ok       configuration") && Contains("vehicle 'two_lidars' with 2 lidars"));
  CHECK_THAT(ended.output, Contains("ok       pools"));
  CHECK_THAT(ended.output,
             Contains("ok       lidar front       ouster:front.pcap?meta=front.json: a sweep of "));
  CHECK_THAT(ended.output, Contains("ok       odometry          tum:odometry.tum:"));
  CHECK_THAT(ended.output, Contains("ok       fusion.backend    cpu gives cpu: as configured"));
  const auto json = nlohmann::json::parse(
      run("gvomctl", {"check", checked.vehicle.file, "--json", "--set", "map.size_xy=128"},
          checked.folder.path())
          .output);
  CHECK(json["ok"] == true);
  CHECK(json["findings"][0]["what"] == "configuration");
}

TEST_CASE("check: odometry of ROS 2 is live, and no file is looked for") {
  const Checked checked;
  const Ended ended = checked.check({"odometry.source=ros2:/odom"});
  INFO(ended.output);
  CHECK(ended.code == 0);
  CHECK_THAT(ended.output, Contains("ok       odometry          ros2:/odom: live"));
}

TEST_CASE("check: what does not work here is an error, and the rest is looked at all the same") {
  const Checked checked;
  const auto fails = [&](const std::vector<std::string>& sets, const std::string& words) {
    const Ended ended = checked.check(sets);
    INFO(ended.output);
    CHECK(ended.code == 1);
    CHECK_THAT(ended.output, Contains(words));
    CHECK_THAT(ended.output, Contains("ok       /tmp"));
  };
  fails({"lidars.front.source=ouster:gone.pcap?meta=front.json"}, "error    lidar front       gone.pcap");
  fails({"lidars.front.source=ouster-udp:17502?meta=gone.json"}, "error    lidar front       gone.json");
  fails({"lidars.front.max_returns=1000"}, "error    lidar front       lidars.front.max_returns is 1000");
  fails({"lidars.rear.source="}, "error    lidar rear        lidars.rear.source is empty");
  fails({"odometry.source=tum:gone.tum"}, "error    odometry          gone.tum");
  fails({"map.size_xy=1024", "map.size_z=256"}, "error    pools             the shared-memory pool of");
  fails({"fusion.backend=cuda"}, "error    fusion.backend    cuda cannot start:");
}

TEST_CASE("check and reload: names that only the bridge looks up make the file wrong, too") {
  const Checked checked;
  for (const char* set :
       {"bridge.mcap.topics=/costmap", "bridge.ros2.topics=/costmap", "bridge.points_layers=/costmap",
        "bridge.base_frame=/costmap", "bridge.ros2.distro=Humble", "bridge.foxglove.address=localhost"})
    for (const char* command : {"check", "reload"}) {
      std::vector<std::string> arguments{command, checked.vehicle.file, "--set", set};
      if (arguments[0] == "reload") arguments.insert(arguments.begin() + 1, "--config");
      const Ended ended = run("gvomctl", arguments, checked.folder.path());
      INFO(ended.output);
      CHECK(ended.code == 78);
      CHECK_THAT(ended.output, Contains(std::string(set).substr(0, std::string(set).find('='))));
    }
}

TEST_CASE("reload: a lidar without a source is told before anything is restarted") {
  const Checked checked;
  std::vector<std::string> arguments{"reload", "--config", checked.vehicle.file, "--dry-run"};
  for (const std::string& given : checked.vehicle.sets) arguments.insert(arguments.end(), {"--set", given});
  arguments.insert(arguments.end(), {"--set", "lidars.rear.source="});
  const Ended ended = run("gvomctl", arguments, checked.folder.path());
  INFO(ended.output);
  CHECK(ended.code == 78);
  CHECK_THAT(ended.output, Contains("lidars.rear.source: is empty") && Contains("nothing was changed"));
}

TEST_CASE("gvom-ingest --check opens the source and decodes a sweep of a recording") {
  const Checked checked;
  const auto check = [&](const std::string& set) {
    std::vector<std::string> arguments{"--config", checked.vehicle.file, "--lidar", "front", "--check"};
    for (const std::string& given : checked.vehicle.sets) arguments.insert(arguments.end(), {"--set", given});
    arguments.insert(arguments.end(), {"--set", set});
    return run("gvom-ingest", arguments, checked.folder.path());
  };
  Ended ended = check("lidars.front.min_sweep_fraction=0.9");
  INFO(ended.output);
  CHECK(ended.code == 0);
  CHECK_THAT(ended.output,
             Contains("lidar front: ouster:front.pcap?meta=front.json: a sweep of ") && Contains("OK"));
  ended = check("lidars.front.source=ouster:gone.pcap?meta=front.json");
  CHECK(ended.code == 65);
  CHECK_THAT(ended.output, Contains("lidar front: gone.pcap") && !Contains("OK"));
  const TakenPort taken;
  ended = check("lidars.front.source=ouster-udp:" + taken.port() + "?meta=front.json");
  CHECK(ended.code == 69);
  CHECK_THAT(ended.output, Contains("process " + std::to_string(::getpid())));
}

TEST_CASE("check: a port that is taken is an error that names the process, a free one is well") {
  const Checked checked;
  TakenPort taken;
  const std::string uri = "ouster-udp:" + taken.port() + "?meta=front.json";
  Ended ended = checked.check({"lidars.front.source=" + uri});
  INFO(ended.output);
  CHECK(ended.code == 1);
  CHECK_THAT(ended.output,
             Contains("UDP port " + taken.port() + " is taken by process " + std::to_string(::getpid())));
  taken.give();
  ended = checked.check({"lidars.front.source=" + uri});
  CHECK(ended.code == 0);
  CHECK_THAT(ended.output, Contains(uri + ": its port can be bound") && Contains("net.core.rmem_max"));
  ended = checked.check({"lidars.front.source=" + uri, "lidars.rear.source=" + uri});
  CHECK(ended.code == 1);
  CHECK_THAT(ended.output, Contains("another lidar of this vehicle has the same"));
}

TEST_CASE("check: files of another user in /tmp are an error") {
  const Checked checked;
  const std::string lock = "/tmp/gvom-fusion.lock";
  std::ofstream(lock) << "";
  if (::chown(lock.c_str(), 12345, 12345) != 0) {
    WARN("SKIPPED: files cannot be given to another user here");
    std::filesystem::remove(lock);
    return;
  }
  const Ended ended = checked.check();
  INFO(ended.output);
  CHECK(ended.code == 1);
  CHECK_THAT(ended.output, Contains("error    owners            left by user 12345") && Contains(lock));
  std::filesystem::remove(lock);
}

TEST_CASE("check: a file that cannot be read as a vehicle's ends with 78, wrong arguments with 64") {
  const TemporaryFolder folder;
  const std::string file = folder.path() + "/bad.yaml";
  std::ofstream(file) << "name: bad\nmap: {sise_xy: 128}\n";
  const Ended bad = run("gvomctl", {"check", file}, folder.path());
  CHECK(bad.code == 78);
  CHECK_THAT(bad.output, Contains("bad.yaml:2"));
  CHECK(run("gvomctl", {"check", "/nowhere.yaml"}, folder.path()).code == 78);
  CHECK(run("gvomctl", {"status", "--config", file}, folder.path()).code == 78);
  for (const auto& arguments :
       std::vector<std::vector<std::string>>{{}, {"check"}, {"stat"}, {"status", "--wait", "x"}})
    CHECK(run("gvomctl", arguments, folder.path()).code == 64);
}
