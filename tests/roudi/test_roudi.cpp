// gvom-roudi as a process: what it exits with, and what it says before.
#include <sys/socket.h>
#include <sys/un.h>

#include <catch2/catch.hpp>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "tests/ipc/processes.hpp"

using namespace gvom;
using namespace gvom::ipc;
using namespace gvom::ipc::test;

namespace {

constexpr char kVehicle[] = "/tmp/vehicle.yaml";
constexpr char kOutput[] = "/tmp/gvom-roudi.out";
constexpr char kNotifySocket[] = "/tmp/notify";

void write_vehicle() {
  std::ofstream(kVehicle) << "name: test\n"
                             "map: {size_xy: 64, size_z: 32}\n"
                             "lidars:\n"
                             "  top:\n"
                             "    max_returns: 10000\n"
                             "    T_base_sensor: {x: 0, y: 0, z: 2, roll: 0, pitch: 0, yaw: 0}\n";
}

/// gvom-roudi with the vehicle above and `set` ("KEY=VALUE") on top of it.
std::function<void()> roudi(const char* set = "name=test") {
  return [set] {
    const int output = ::open(kOutput, O_CREAT | O_TRUNC | O_WRONLY, 0600);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::execl(GVOM_ROUDI, "gvom-roudi", "--config", kVehicle, "--set", set, nullptr);
    ::_exit(127);
  };
}

std::string output() {
  std::ostringstream text;
  text << std::ifstream(kOutput).rdbuf();
  return text.str();
}

bool says(const std::string& words) {
  return eventually([&] { return output().find(words) != std::string::npos; });
}

/// A socket that stands in for systemd's.
int listen_for_notifications() {
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, kNotifySocket, sizeof(address.sun_path) - 1);
  ::unlink(kNotifySocket);
  REQUIRE(::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0);
  return fd;
}

std::string next_notification(int fd) {
  char text[256] = {};
  const timeval patience{10, 0};
  ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  return ::recv(fd, text, sizeof(text) - 1, 0) > 0 ? text : "nothing came";
}

}  // namespace

TEST_CASE("it tells systemd that it is ready, feeds the watchdog, and stops on SIGTERM and SIGINT") {
  write_vehicle();
  for (const int signal : {SIGTERM, SIGINT}) {
    const int notifications = listen_for_notifications();
    Child child([] {
      ::setenv("NOTIFY_SOCKET", kNotifySocket, 1);
      roudi()();
    });
    bool ready = false;
    bool watchdog = false;
    while (!(ready && watchdog)) {
      const std::string line = next_notification(notifications);
      REQUIRE(line != "nothing came");
      if (line.find("READY=1") != std::string::npos) {
        ready = true;
        CHECK(broker_answers());
      }
      watchdog = watchdog || line.find("WATCHDOG=1") != std::string::npos;
    }
    CHECK(says("MB of shared memory"));
    child.send(signal);
    CHECK(child.wait() == 0);
    CHECK(!broker_answers());
    ::close(notifications);
  }
}

TEST_CASE("a second broker is told to try again") {
  write_vehicle();
  BrokerProcess first;
  REQUIRE(first.is_up());
  CHECK(Child(roudi()).wait() == 75);
  CHECK(says("another broker"));
}

TEST_CASE("pools that cannot be are an error of the configuration that names the key") {
  write_vehicle();
  CHECK(Child(roudi("map.size_xy=1024")).wait() == 78);
  CHECK(says("map.size_xy"));
  CHECK(says("4 GiB"));
}
