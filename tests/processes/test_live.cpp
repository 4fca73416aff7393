// The live path: a recording's packets over UDP, and whatever else comes to that port.
#include <sys/socket.h>
#include <unistd.h>
#include <catch2/catch.hpp>

#include <random>

#include "tests/ingest/ouster_builder.hpp"
#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/support/local_address.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom::test;
using gvom::ipc::test::eventually;
using namespace std::chrono_literals;

namespace {

constexpr char kIngest[] = "gvom-ingest-front";
constexpr int kSweeps = 20;
constexpr char kPace[] =
    "0.25";  // times the recorded one: a busy machine, too, has to keep up with all of it

/// Sends datagrams from 127.0.0.HOST.
class Sender {
 public:
  Sender(std::uint16_t port, std::uint8_t host)
      : fd_(::socket(AF_INET, SOCK_DGRAM, 0)), to_(local_address(port)) {
    const sockaddr_in from = local_address(0, 0x7F000000u + host);
    REQUIRE(::bind(fd_, reinterpret_cast<const sockaddr*>(&from), sizeof from) == 0);
  }
  ~Sender() { ::close(fd_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  void send(const ByteVector& bytes) const {
    ::sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_);
  }

 private:
  int fd_;
  sockaddr_in to_;
};

/// The simulated front lidar, live on a port.
Vehicle live_front(const std::string& folder, std::uint16_t port) {
  Vehicle vehicle = front_only(folder);
  vehicle.sets.push_back("lidars.front.source=ouster-udp:" + std::to_string(port) + "?meta=front.json");
  return vehicle;
}

/// Plays the drive to the port beside the odometry; `meanwhile` runs as long as packets come.
template <class Meanwhile>
void drive_live(Graph& graph, std::uint16_t port, Meanwhile meanwhile) {
  const auto odometry = graph.replay({"--rate", kPace});
  Program play("gvom-play", {"front.pcap", "--rate", kPace, "--port", std::to_string(port)},
               graph.vehicle().folder);
  while (play.runs()) meanwhile();
  const int played = play.wait();
  INFO(play.output());
  REQUIRE(played == 0);
  REQUIRE(odometry->wait() == 0);
}

struct Live {
  Live() : port(free_port()) {
    simulated(folder.path(), kSweeps / 10.0);
    expected = last_map(map_offline(front_only(folder.path()), "maps"));
    graph = std::make_unique<Graph>(live_front(folder.path(), port));
    observer = std::make_unique<Observer>(folder.path());
    REQUIRE(observer->is_up());
    graph->start_readers();
    snapshot = graph->start("gvom-snapshot", {"--out", folder.path() + "/out", "--final", "--npy"});
    REQUIRE(graph->ingest("front").says("front from"));
    REQUIRE(graph->fusion().says("fusing"));
  }

  /// The layers at the end are those of the recording without anything else on the port.
  void finish() {
    const bool all = eventually([&] { return observer->counter(kIngest, "sweeps_mapped") == kSweeps; });
    INFO(observer->drops(kIngest) << "\n" << graph->ingest("front").output());
    CHECK(all);
    CHECK(eventually([&] {  // ... and published
      return observer->counter("gvom-fusion", "layers_out") +
                 observer->counter("gvom-fusion", "maps_sharing_layers") ==
             kSweeps;
    }));
    CHECK(snapshot->stop() == 0);
    CHECK(differences(expected, last_map(folder.path() + "/out")) == "");
    CHECK(observer->counter(kIngest, "sweeps_in") == kSweeps);
    CHECK(observer->counter(kIngest, "sweep_incomplete") == 0);
    CHECK(observer->counter("gvom-fusion", "maps_lost") == 0);
    CHECK(observer->drops("gvom-fusion") == "");
  }

  TemporaryFolder folder;
  std::uint16_t port;
  std::string expected;
  std::unique_ptr<Graph> graph;
  std::unique_ptr<Observer> observer;
  std::unique_ptr<Program> snapshot;
};

}  // namespace

TEST_CASE("a lidar over UDP gives the layers of its recording, and nothing is dropped but by range") {
  Live live;
  drive_live(*live.graph, live.port, [] { std::this_thread::sleep_for(20ms); });
  live.finish();
  for (const char* counter :
       {"drop_before_odometry", "drop_odometry_timeout", "drop_overrun", "drop_no_chunk",
        "drop_sweep_incomplete", "drop_packet_foreign", "drop_packet_truncated", "drop_packet_duplicate",
        "drop_packet_late", "drop_packet_fragment", "drop_packet_kernel", "packet_out_of_order",
        "column_invalid", "odometry_lost"}) {
    INFO(counter);
    CHECK(live.observer->counter(kIngest, counter) == 0);
  }
  live.graph->stop();
}

TEST_CASE("another sensor and garbage on the same port are counted, and the map is unharmed") {
  Live live;
  // Another model, from the same address.
  OusterSensor other;
  other.beams = 16;
  PcapWriter pcap(live.folder.path() + "/other.pcap");
  for (int i = 0; i < 400; ++i)
    pcap.add(frame(plain_packet(other, i / 4, i % 4 * 4)), std::int64_t{5'000'000} * i);
  pcap.write();

  const Sender same_host(live.port, 1);
  const Sender other_host(live.port, 2);
  std::minstd_rand random(1);
  const auto garbage = [&](std::size_t bytes) {
    ByteVector datagram(bytes);
    for (auto& byte : datagram) byte = static_cast<std::uint8_t>(random());
    return datagram;
  };
  Program other_play("gvom-play", {"other.pcap", "--port", std::to_string(live.port)}, live.folder.path());
  std::uint64_t sent = 0;
  int turn = 0;
  drive_live(*live.graph, live.port, [&] {
    for (const std::size_t bytes : {0UL, 1UL, 48UL, 1206UL, 9000UL}) same_host.send(garbage(bytes));
    other_host.send(garbage(1206));
    sent += 6;
    if (++turn % 20 == 0) {  // seldom: the socket's buffer must not overflow
      same_host.send(garbage(60'000));
      ++sent;
    }
    std::this_thread::sleep_for(10ms);
  });
  CHECK(other_play.wait() == 0);
  CHECK(sent > 100);
  CHECK(eventually([&] { return live.observer->counter(kIngest, "drop_packet_foreign") == sent + 400; }));
  live.finish();
  CHECK(live.graph->ingest("front").runs());
  live.graph->stop();
}
