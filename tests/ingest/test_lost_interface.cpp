// An interface that goes while a live source listens on it. In a network of its own (run-private-network.sh).
#include <cstdlib>

#include "tests/ingest/live_socket.hpp"
#include "tests/ingest/ouster_builder.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using gvom::ingest::SourceEvent;

namespace {

bool run(const std::string& command) {
  INFO(command);
  return std::system(command.c_str()) == 0;
}

/// sensor0, to which the route of all groups leads.
bool add_interface() {
  return run(
      "ip link add sensor0 type veth peer name sensor1 && ip link set sensor1 up &&"
      " ip link set sensor0 up && ip addr add 10.9.8.1/24 dev sensor0 &&"
      " ip route replace 224.0.0.0/4 dev sensor0");
}

}  // namespace

TEST_CASE("a group's interface that goes ends the source, whether it was named or the route's") {
  for (const char* named : {"", "&interface=sensor0"}) {
    if (!add_interface()) {
      WARN("SKIPPED: no interface can be made here");
      return;
    }
    TemporaryFolder folder;
    const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
    const auto source =
        open("ouster-udp:" + std::to_string(free_port()) + "?meta=" + meta + "&group=239.1.1.1" + named);
    Sweep sweep;
    const auto before = source->next(sweep, std::chrono::milliseconds(1));
    REQUIRE(before.has_value());
    CHECK(*before == SourceEvent::kIdle);
    REQUIRE(run("ip link del sensor0"));
    REQUIRE(add_interface());  // another one by that name
    const auto after = source->next(sweep, std::chrono::milliseconds(1));
    REQUIRE_FALSE(after.has_value());
    CHECK(after.error().find("on sensor0: the interface is gone") != std::string::npos);
    REQUIRE(run("ip link del sensor0"));
  }
}
