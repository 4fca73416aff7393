// Packets over the loopback, through the same decoder as a recording's.
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "ipc/clock.hpp"
#include "services/ingest/udp_receiver.hpp"
#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using gvom::ingest::SourceEvent;

namespace {

/// A socket on this machine. `port` is 0 for one that the kernel chooses.
class Socket {
 public:
  explicit Socket(const std::string& own = "127.0.0.1", std::uint16_t port = 0) {
    const auto at = ingest::socket_address(ingest::parse_address(own).value(), port);
    socket_ = ::socket(at.storage.ss_family, SOCK_DGRAM, 0);
    REQUIRE(::bind(socket_, at.get(), at.size) == 0);
    sockaddr_in6 bound{};
    socklen_t size = sizeof bound;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&bound), &size);
    port_ = ntohs(bound.sin6_port);  // where a sockaddr_in has it too
  }
  ~Socket() { ::close(socket_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  [[nodiscard]] int get() const { return socket_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  void send(std::uint16_t to, const ByteVector& payload) const { send("127.0.0.1", to, payload); }
  void send(const std::string& host, std::uint16_t port, const ByteVector& payload) const {
    const auto to = ingest::socket_address(ingest::parse_address(host).value(), port);
    REQUIRE(::sendto(socket_, payload.data(), payload.size(), 0, to.get(), to.size) ==
            static_cast<ssize_t>(payload.size()));
  }

 private:
  int socket_ = -1;
  std::uint16_t port_ = 0;
};

std::uint16_t free_port() {
  return Socket().port();
}

constexpr std::chrono::milliseconds kWait(200);

/// The counters of a live source after a frame of the small sensor from `sender` to HOST.
ingest::SourceCounters counts_of(ingest::Source& source, const Socket& sender, const std::string& host,
                                 std::uint16_t port) {
  for (int column = 0; column < 16; column += 4) sender.send(host, port, plain_packet({}, 1, column));
  Sweep sweep;
  REQUIRE(source.next(sweep, kWait).has_value());
  return source.counters();
}

/// An interface that does IPv6 multicast, which the loopback does not; empty if there is none.
std::string multicast_interface() {
  ifaddrs* all = nullptr;
  REQUIRE(::getifaddrs(&all) == 0);
  std::string name;
  for (const ifaddrs* one = all; one != nullptr && name.empty(); one = one->ifa_next) {
    const unsigned wanted = IFF_UP | IFF_RUNNING | IFF_MULTICAST;
    const bool ipv6 = one->ifa_addr != nullptr && one->ifa_addr->sa_family == AF_INET6;
    if (ipv6 && (one->ifa_flags & (wanted | IFF_LOOPBACK)) == wanted) name = one->ifa_name;
  }
  ::freeifaddrs(all);
  if (name.empty()) WARN("SKIPPED: no interface here does IPv6 multicast");
  return name;
}

/// Whether this machine has the address ::1.
bool has_ipv6() {
  const auto at = ingest::socket_address(ingest::parse_address("::1").value(), 0);
  const int socket = ::socket(AF_INET6, SOCK_DGRAM, 0);
  const bool has = socket >= 0 && ::bind(socket, at.get(), at.size) == 0;
  ::close(socket);
  if (!has) WARN("SKIPPED: no IPv6 on this machine");
  return has;
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
  for (int column = 0; column < 12; column += 4) sensor.send(port, plain_packet({}, 1, column));
  const std::int64_t before_ns = ipc::monotonic_ns();
  CHECK(source->next(sweep, std::chrono::milliseconds(20)).value() == SourceEvent::kIdle);
  sensor.send(port, ByteVector(10));
  sensor.send(port, plain_packet({}, 1, 12));
  REQUIRE(source->next(sweep, kWait).value() == SourceEvent::kSweep);
  CHECK(sweep.complete);
  CHECK(sweep.returns.size() == 32);
  CHECK(sweep.received_ns >= before_ns);
  CHECK(sweep.received_ns <= ipc::monotonic_ns());
  sensor.send(port, ByteVector(48));  // of the IMU
  CHECK(source->next(sweep, std::chrono::milliseconds(20)).value() == SourceEvent::kIdle);
  CHECK(source->counters().packets == 6);
  CHECK(source->counters().foreign_packets == 2);
  CHECK(source->counters().side_packets == 1);
}

TEST_CASE("a sweep's age counts what its packets waited in the socket's queue") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const std::uint16_t port = free_port();
  auto source = open("ouster-udp:" + std::to_string(port) + "?bind=127.0.0.1&meta=" + meta);
  const Socket sensor;
  Sweep sweep;
  std::int64_t last_ns = 0;
  for (int frame = 1; frame <= 3; ++frame) {
    CHECK(source->next(sweep, std::chrono::milliseconds(0)).value() == SourceEvent::kIdle);
    for (int column = 0; column < 16; column += 4) sensor.send(port, plain_packet({}, frame, column));
    const std::int64_t sent_ns = ipc::monotonic_ns();  // on the loopback the kernel has them now
    REQUIRE(source->next(sweep, kWait).value() == SourceEvent::kSweep);
    CHECK(sweep.received_ns <= sent_ns);
    CHECK(sweep.received_ns >= last_ns);
    last_ns = sent_ns;
  }
}

TEST_CASE("a live packet has the kernel's time, on both clocks") {
  ingest::SourceState state;
  const std::uint16_t port = free_port();
  const auto receiver =
      ingest::UdpReceiver::open({port, ingest::parse_address("127.0.0.1"), {}, {}}, state).value();
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
  REQUIRE(source->next(sweep, std::chrono::milliseconds(100)).has_value());
  CHECK(source->counters().kernel_drops == kSent - received);
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
  CHECK(source->next(sweep, std::chrono::milliseconds(20)).value() == SourceEvent::kIdle);
  CHECK(source->counters().second_sensor_packets == 12);
  CHECK(source->counters().second_kind.data() == std::string("serial number 6, the metadata is of 5"));
  for (int column = 0; column < 16; column += 4) sender.send(port, plain_packet(ours, 1, column));
  REQUIRE(source->next(sweep, kWait).value() == SourceEvent::kSweep);
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
  CHECK(source->next(sweep, std::chrono::milliseconds(20)).value() == SourceEvent::kIdle);
  CHECK(source->counters().foreign_packets == 1);
  CHECK(source->counters().foreign_kind.data() == std::string("a VLS-128, model byte 0xA1"));
  REQUIRE(source->warnings().size() == 1);
  CHECK(source->warnings()[0].find("packets of another sensor (a VLS-128") == 0);
}

TEST_CASE("without an address a port takes IPv4 and IPv6, with one that address only") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const auto at = [&](std::uint16_t port, const std::string& options) {
    return open("ouster-udp:" + std::to_string(port) + "?meta=" + meta + options);
  };
  std::uint16_t port = free_port();
  CHECK(counts_of(*at(port, ""), Socket("127.0.0.1"), "127.0.0.1", port).sweeps == 1);
  if (!has_ipv6()) return;
  CHECK(counts_of(*at(port, ""), Socket("::1"), "::1", port).sweeps == 1);
  CHECK(counts_of(*at(port, "&bind=::1"), Socket("::1"), "::1", port).sweeps == 1);
  CHECK(counts_of(*at(port, "&bind=::1"), Socket("127.0.0.1"), "127.0.0.1", port).packets == 0);
  CHECK(counts_of(*at(port, "&interface=lo"), Socket("::1"), "::1", port).sweeps == 1);
}

TEST_CASE("only the packets of the sender that is asked for are used, and who else sends is told") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const std::uint16_t port = free_port();
  auto source = open("ouster-udp:" + std::to_string(port) + "?from=127.0.0.3&meta=" + meta);
  const auto others = counts_of(*source, Socket("127.0.0.2"), "127.0.0.1", port);
  CHECK(others.sweeps == 0);
  CHECK(others.second_sensor_packets == 4);
  CHECK(std::string(ingest::to_text(others.second_address).data()) == "127.0.0.2");
  CHECK(counts_of(*source, Socket("127.0.0.3"), "127.0.0.1", port).sweeps == 1);
}

TEST_CASE("a multicast group is joined where the source says, and nothing else comes in") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const std::uint16_t port = free_port();
  const auto at = [&](const std::string& options) {
    return open("ouster-udp:" + std::to_string(port) + "?meta=" + meta + options);
  };
  const Socket sensor("127.0.0.1");
  const ip_mreqn by_loopback{{}, {}, static_cast<int>(::if_nametoindex("lo"))};
  REQUIRE(::setsockopt(sensor.get(), IPPROTO_IP, IP_MULTICAST_IF, &by_loopback, sizeof by_loopback) == 0);
  auto source = at("&group=239.201.201.201&interface=lo");
  auto recorder = at("&group=239.201.201.201&interface=lo");  // both hear it
  CHECK(counts_of(*source, sensor, "239.201.201.201", port).sweeps == 1);
  Sweep sweep;
  CHECK(recorder->next(sweep, kWait).value() == SourceEvent::kSweep);
  CHECK(counts_of(*source, sensor, "127.0.0.1", port).packets == 4);        // not to the group
  CHECK(counts_of(*source, sensor, "239.201.201.202", port).packets == 4);  // another group
}

TEST_CASE("an IPv6 group is joined too") {
  const std::string name = multicast_interface();
  if (name.empty()) return;
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const std::uint16_t port = free_port();
  const Socket sensor("::");
  const unsigned interface = ::if_nametoindex(name.c_str());
  REQUIRE(::setsockopt(sensor.get(), IPPROTO_IPV6, IPV6_MULTICAST_IF, &interface, sizeof interface) == 0);
  const std::string group = "ff11::201";  // does not leave this machine
  auto source =
      open("ouster-udp:" + std::to_string(port) + "?meta=" + meta + "&group=" + group + "&interface=" + name);
  CHECK(counts_of(*source, sensor, group, port).sweeps == 1);
}

TEST_CASE("where a live source cannot listen: what is wrong is told, and whether it can be right later") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  using Kind = ingest::SourceError::Kind;
  struct Case {
    const char* options;
    Kind kind;
    const char* words;
  };
  const Case cases[] = {
      {"group=192.168.1.7", Kind::bad_data, "group: '192.168.1.7' is no multicast group"},
      {"group=239.1.1.1&bind=127.0.0.1", Kind::bad_data, "exclude each other"},
      {"bind=239.1.1.1", Kind::bad_data, "bind: '239.1.1.1' is a multicast group"},
      {"from=ff02::1", Kind::bad_data, "from: 'ff02::1' is a multicast group"},
      {"from=front", Kind::bad_data, "from: 'front' is not an IPv4 or IPv6 address"},
      {"bind=fe80::1%lo&interface=eth0", Kind::bad_data, "is of another interface than eth0"},
      {"group=239.1.1.1&interface=no-such0", Kind::unavailable, "on no-such0: no such interface"},
      {"interface=no-such0", Kind::unavailable, "on no-such0: no such interface"},
      {"bind=2001:db8::1", Kind::unavailable, "on 2001:db8::1: "},
  };
  const std::string port = std::to_string(free_port());
  for (const Case& c : cases) {
    const auto source = ingest::open_source("ouster-udp:" + port + "?meta=" + meta + "&" + c.options, {});
    REQUIRE_FALSE(source.has_value());
    INFO(source.error().what);
    CHECK(source.error().kind == c.kind);
    CHECK(source.error().what.find(c.words) != std::string::npos);
  }
}
