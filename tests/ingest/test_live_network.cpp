// Where a live source listens: addresses, interfaces, multicast groups, senders.
#include <ifaddrs.h>
#include <net/if.h>

#include "tests/ingest/live_socket.hpp"
#include "tests/ingest/ouster_builder.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;

namespace {

/// Whether frames of the small sensor from `sender` to HOST become sweeps.
bool hears(ingest::Source& source, const Socket& sender, const std::string& host, std::uint16_t port) {
  Sweep sweep;
  return first_sweep(source, sweep, sender, host, port) != 0;
}

/// The counters of a live source after such a frame, which makes it `packets` packets in all.
ingest::SourceCounters counts_of(ingest::Source& source, const Socket& sender, const std::string& host,
                                 std::uint16_t port, std::uint64_t packets) {
  for (int column = 0; column < 16; column += 4) sender.send(host, port, plain_packet({}, 1, column));
  Sweep sweep;
  read_to(source, sweep, packets);
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

TEST_CASE("without an address a port takes IPv4 and IPv6, with one that address only") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const auto at = [&](std::uint16_t port, const std::string& options) {
    return open("ouster-udp:" + std::to_string(port) + "?meta=" + meta + options);
  };
  std::uint16_t port = free_port();
  CHECK(hears(*at(port, ""), Socket("127.0.0.1"), "127.0.0.1", port));
  if (!has_ipv6()) return;
  CHECK(hears(*at(port, ""), Socket("::1"), "::1", port));
  CHECK(hears(*at(port, "&bind=::1"), Socket("::1"), "::1", port));
  CHECK(counts_of(*at(port, "&bind=::1"), Socket("127.0.0.1"), "127.0.0.1", port, 0).packets == 0);
  CHECK(hears(*at(port, "&interface=lo"), Socket("::1"), "::1", port));
}

TEST_CASE("only the packets of the sender that is asked for are used, and who else sends is told") {
  TemporaryFolder folder;
  const std::string meta = write_text(folder.path() + "/meta.json", OusterSensor{}.json());
  const std::uint16_t port = free_port();
  auto source = open("ouster-udp:" + std::to_string(port) + "?from=127.0.0.3&meta=" + meta);
  const auto others = counts_of(*source, Socket("127.0.0.2"), "127.0.0.1", port, 4);
  CHECK(others.sweeps == 0);
  CHECK(others.second_sensor_packets == 4);
  CHECK(std::string(ingest::to_text(others.second_address).data()) == "127.0.0.2");
  CHECK(hears(*source, Socket("127.0.0.3"), "127.0.0.1", port));
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
  CHECK(hears(*source, sensor, "239.201.201.201", port));
  const std::uint64_t heard = source->counters().packets;
  Sweep sweep;
  read_to(*recorder, sweep, heard);
  CHECK(counts_of(*source, sensor, "127.0.0.1", port, heard).packets == heard);        // not to the group
  CHECK(counts_of(*source, sensor, "239.201.201.202", port, heard).packets == heard);  // another group
  CHECK(hears(*recorder, sensor, "239.201.201.201", port));
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
  CHECK(hears(*source, sensor, group, port));
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
