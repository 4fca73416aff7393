// Packets over the loopback, through the same decoder as a recording's.
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include "ipc/clock.hpp"
#include "services/ingest/udp_receiver.hpp"
#include "tests/ingest/live_socket.hpp"
#include "tests/ingest/ouster_builder.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using gvom::ingest::SourceEvent;

namespace {

constexpr const char* kHost = "127.0.0.1";
constexpr std::chrono::milliseconds kWait(20'000);  // for a packet that was sent

/// As long as it lives the kernel stamps packets when they come. It begins to a few milliseconds after the
/// first socket asks for that; until then the stamp is the time at which a packet is read.
class KernelStamps {
 public:
  KernelStamps() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!stamps()) REQUIRE(std::chrono::steady_clock::now() < end);
  }

 private:
  bool stamps() {
    socket_.send(port_, {1});
    const std::int64_t sent_ns = ipc::clock_ns(CLOCK_REALTIME);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ingest::Packet packet;
    REQUIRE(receiver_->next(packet, kWait).value() == ingest::PacketEvent::packet);
    return packet.capture_ns <= sent_ns;
  }

  const Socket socket_;
  const std::uint16_t port_ = free_port();
  ingest::SourceState state_;
  const std::unique_ptr<ingest::UdpReceiver> receiver_ =
      ingest::UdpReceiver::open({port_, ingest::parse_address(kHost), {}, {}}, state_).value();
};

/// How many packets to this port the kernel had no room for, as it says itself.
std::uint64_t dropped_at(std::uint16_t port) {
  char place[32];
  std::snprintf(place, sizeof place, ":%04X 00000000:0000 ", port);
  std::ifstream sockets("/proc/net/udp");
  for (std::string line; std::getline(sockets, line);) {
    if (line.find(place) == std::string::npos) continue;
    std::istringstream words(line);
    std::string last;
    while (words >> last) continue;
    return std::stoull(last);
  }
  return 0;
}

}  // namespace

TEST_CASE("a live source is idle, then gives the sweep, with the moment at which its last packet came") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const std::uint16_t port = free_port();
  auto source = open("ouster-udp:" + std::to_string(port) + "?bind=127.0.0.1&meta=" + meta);
  CHECK(source->is_live());
  CHECK_FALSE(source->rewind().has_value());
  Sweep sweep;
  CHECK(source->next(sweep, std::chrono::milliseconds(1)).value() == SourceEvent::kIdle);

  const Socket sensor;
  const int frame = first_sweep(*source, sweep, sensor, kHost, port) + 1;
  const std::uint64_t before = source->counters().packets;
  for (int column = 0; column < 12; column += 4) sensor.send(port, plain_packet({}, frame, column));
  CHECK_FALSE(read_to(*source, sweep, before + 3));
  const std::int64_t before_ns = ipc::monotonic_ns();
  CHECK(source->next(sweep, std::chrono::milliseconds(20)).value() == SourceEvent::kIdle);
  sensor.send(port, ByteVector(10));
  sensor.send(port, plain_packet({}, frame, 12));
  REQUIRE(read_to(*source, sweep, before + 5));
  CHECK(sweep.complete);
  CHECK(sweep.returns.size() == 32);
  CHECK(sweep.received_ns >= before_ns);
  CHECK(sweep.received_ns <= ipc::monotonic_ns());
  sensor.send(port, ByteVector(48));  // of the IMU
  CHECK_FALSE(read_to(*source, sweep, before + 6));
  CHECK(source->counters().packets == before + 6);
  CHECK(source->counters().foreign_packets == 2);
  CHECK(source->counters().side_packets == 1);
}

TEST_CASE("a sweep's age counts what its packets waited in the socket's queue") {
  const KernelStamps stamps;
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const std::uint16_t port = free_port();
  auto source = open("ouster-udp:" + std::to_string(port) + "?bind=127.0.0.1&meta=" + meta);
  const Socket sensor;
  Sweep sweep;
  std::int64_t last_ns = 0;
  const int first = first_sweep(*source, sweep, sensor, kHost, port) + 1;
  for (int frame = first; frame < first + 3; ++frame) {
    CHECK(source->next(sweep, std::chrono::milliseconds(0)).value() == SourceEvent::kIdle);
    for (int column = 0; column < 16; column += 4) sensor.send(port, plain_packet({}, frame, column));
    const std::int64_t sent_ns = ipc::monotonic_ns();  // on the loopback the kernel has them now
    REQUIRE(read_to(*source, sweep, source->counters().packets + 4));
    CHECK(sweep.received_ns <= sent_ns);
    CHECK(sweep.received_ns >= last_ns);
    last_ns = sent_ns;
  }
}

TEST_CASE("a live packet has the kernel's time, on both clocks") {
  const KernelStamps stamps;
  ingest::SourceState state;
  const std::uint16_t port = free_port();
  const auto receiver =
      ingest::UdpReceiver::open({port, ingest::parse_address(kHost), {}, {}}, state).value();
  const Socket sensor;
  const std::int64_t before_ns = ipc::clock_ns(CLOCK_REALTIME);
  sensor.send(port, {1, 2, 3});
  const std::int64_t after_ns = ipc::clock_ns(CLOCK_REALTIME);
  ingest::Packet packet;
  REQUIRE(receiver->next(packet, kWait).value() == ingest::PacketEvent::packet);
  CHECK(packet.capture_ns >= before_ns);
  CHECK(packet.capture_ns <= after_ns);
}

TEST_CASE("a port that is taken and an address that is not up are errors that name them, to be tried again") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const Socket other;
  const std::string uri = "ouster-udp:" + std::to_string(other.port()) + "?meta=" + meta + "&bind=";
  const auto taken = ingest::open_source(uri + "127.0.0.1", {});
  REQUIRE_FALSE(taken.has_value());
  CHECK(taken.error().what.find("UDP port " + std::to_string(other.port()) + " on 127.0.0.1: ") == 0);
  CHECK(taken.error().kind == ingest::SourceError::Kind::unavailable);
  const auto down = ingest::open_source(uri + "192.0.2.1", {});  // TEST-NET-1: nobody's
  REQUIRE_FALSE(down.has_value());
  CHECK(down.error().kind == ingest::SourceError::Kind::unavailable);
  const auto wrong = ingest::open_source(uri + "my-lidar", {});
  REQUIRE_FALSE(wrong.has_value());
  CHECK(wrong.error().kind == ingest::SourceError::Kind::bad_data);
}

TEST_CASE("packets that the kernel had no room for are counted") {
  TemporaryFolder folder;
  OusterSensor sensor;
  sensor.columns = 1024;
  sensor.columns_per_packet = 64;
  sensor.window = "[0, 1023]";
  const std::string meta = write_text(folder.path() + "/meta.json", sensor.json());
  const std::uint16_t port = free_port();
  auto source = open("ouster-udp:" + std::to_string(port) + "?bind=127.0.0.1&meta=" + meta);
  const Socket sender;
  constexpr int kSent = 30000;  // 82 MB, more than any buffer that is asked for
  const ByteVector packet = plain_packet(sensor, 1, 0);
  for (int i = 0; i < kSent; ++i) sender.send(port, packet);
  Sweep sweep;
  std::uint64_t received = 0;
  do {  // that it is idle may only mean that it has read for long
    received = source->counters().packets;
    REQUIRE(source->next(sweep, std::chrono::milliseconds(1)).has_value());
  } while (source->counters().packets != received);
  REQUIRE(received > 0);
  sender.send(port, packet);  // brings the count with it
  for (int i = 0; i < 1000 && source->counters().kernel_drops != dropped_at(port); ++i)
    REQUIRE(source->next(sweep, std::chrono::milliseconds(20)).has_value());
  CHECK(source->counters().kernel_drops == dropped_at(port));
  CHECK(source->counters().kernel_drops > 0);
  CHECK(source->counters().kernel_drops <= kSent - received);  // a busy machine loses some before the socket
}

TEST_CASE("live, packets that prove to be of another kind of sensor are counted and named, and ours go on") {
  TemporaryFolder folder;
  OusterSensor ours;
  ours.profile = "RNG15_RFL8_NIR8";
  ours.serial = 5;
  OusterSensor other = ours;
  other.serial = 6;
  const std::string meta = write_text(folder.path() + "/meta.json", ours.json());
  const std::uint16_t port = free_port();
  auto source = open("ouster-udp:" + std::to_string(port) + "?bind=127.0.0.1&meta=" + meta);
  const Socket sender;
  for (int frame = 1; frame <= 3; ++frame)
    for (int column = 0; column < 16; column += 4) sender.send(port, plain_packet(other, frame, column));
  Sweep sweep;
  CHECK_FALSE(read_to(*source, sweep, 12));
  CHECK(source->counters().sweeps == 0);
  CHECK(source->counters().second_sensor_packets == 12);
  CHECK(source->counters().second_kind.data() == std::string("serial number 6, the metadata is of 5"));
  REQUIRE(first_sweep(*source, sweep, sender, kHost, port, ours) != 0);
  CHECK(sweep.returns.size() == 32);
}

TEST_CASE("live, a Velodyne of another model is named, and its packets are not used") {
  const std::uint16_t port = free_port();
  auto source = open("velodyne-udp:" + std::to_string(port) + "?bind=127.0.0.1&model=VLP-16");
  const Socket sender;
  ByteVector packet(1206);
  for (std::size_t block = 0; block < 12; ++block) {
    packet[100 * block] = 0xFF;
    packet[100 * block + 1] = static_cast<std::uint8_t>(0xEE - 0x11 * (block % 4));
  }
  packet[1204] = 0x37;
  packet[1205] = 0xA1;
  sender.send(port, packet);
  Sweep sweep;
  CHECK_FALSE(read_to(*source, sweep, 1));
  CHECK(source->counters().foreign_packets == 1);
  CHECK(source->counters().foreign_kind.data() == std::string("a VLS-128, model byte 0xA1"));
  REQUIRE(source->warnings().size() == 1);
  CHECK(source->warnings()[0].find("packets of another sensor (a VLS-128") == 0);
}
