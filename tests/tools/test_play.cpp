// A recording goes out of gvom-play as it was captured: the same payloads, in order, at the pace asked for.
#include <array>
#include <chrono>
#include <fstream>
#include <numeric>
#include <thread>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>
#include <catch2/catch.hpp>

#include "services/ingest/pcap_reader.hpp"
#include "services/ingest/udp_receiver.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/play/player.hpp"

using namespace gvom::play;
using gvom::ingest::PcapReader;
using gvom::ingest::SourceState;
using gvom::test::TemporaryFolder;
using Bytes = std::vector<std::uint8_t>;

namespace {

/// A classic pcap file (little-endian, microseconds) of raw IPv4 packets.
class PcapFile {
 public:
  explicit PcapFile(const std::string& path) : file_(path, std::ios::binary) {
    for (const std::uint32_t word : {0xA1B2C3D4U, 0x00040002U, 0U, 0U, 65535U, kRawIp}) put(word);
  }
  ~PcapFile() { file_.flush(); }

  void datagram(std::uint32_t time_us, std::uint16_t port, const Bytes& payload) {
    packet(time_us, 0, udp(port, payload));
  }

  /// In two IP fragments, the later part first.
  void fragmented(std::uint32_t time_us, std::uint16_t port, const Bytes& payload) {
    const Bytes whole = udp(port, payload);
    const std::size_t half = whole.size() / 2 / 8 * 8;
    packet(time_us, static_cast<std::uint16_t>(half / 8),
           Bytes(whole.begin() + static_cast<long>(half), whole.end()));
    packet(time_us, 0x2000, Bytes(whole.begin(), whole.begin() + static_cast<long>(half)));
  }

 private:
  static constexpr std::uint32_t kRawIp = 101;

  void put(std::uint32_t word) { file_.write(reinterpret_cast<const char*>(&word), sizeof word); }

  static void put16(Bytes& out, std::size_t value) {
    out.push_back(static_cast<std::uint8_t>(value >> 8));
    out.push_back(static_cast<std::uint8_t>(value));
  }

  static Bytes udp(std::uint16_t port, const Bytes& payload) {
    Bytes out;
    put16(out, 5555);
    put16(out, port);
    put16(out, payload.size() + 8);
    put16(out, 0);
    out.insert(out.end(), payload.begin(), payload.end());
    return out;
  }

  void packet(std::uint32_t time_us, std::uint16_t fragment, const Bytes& body) {
    Bytes ip{0x45, 0};
    put16(ip, body.size() + 20);
    put16(ip, 7);
    put16(ip, fragment);
    ip.insert(ip.end(), {64, 17, 0, 0, 10, 0, 0, 1, 10, 0, 0, 2});
    ip.insert(ip.end(), body.begin(), body.end());
    const auto size = static_cast<std::uint32_t>(ip.size());
    for (const std::uint32_t word : {1000U, time_us, size, size}) put(word);
    file_.write(reinterpret_cast<const char*>(ip.data()), static_cast<long>(ip.size()));
  }

  std::ofstream file_;
};

/// A socket on a free port of this machine.
class Listener {
 public:
  Listener() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
    socklen_t length = sizeof address;
    REQUIRE(::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &length) == 0);
    port_ = ntohs(address.sin_port);
    const timeval patience{60, 0};
    REQUIRE(::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience) == 0);
  }
  ~Listener() { ::close(socket_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }

  /// So many datagrams, waited for, and what else has come by then.
  std::vector<Bytes> received(std::size_t count) const {
    std::vector<Bytes> out;
    std::array<std::uint8_t, 65536> buffer;
    ssize_t size = 0;
    while ((size = ::recv(socket_, buffer.data(), buffer.size(), out.size() < count ? 0 : MSG_DONTWAIT)) >= 0)
      out.emplace_back(buffer.begin(), buffer.begin() + size);
    return out;
  }

 private:
  int socket_;
  std::uint16_t port_ = 0;
};

Bytes counting(std::size_t size, std::uint8_t first) {
  Bytes out(size);
  std::iota(out.begin(), out.end(), first);
  return out;
}

bool sleep_until(std::chrono::steady_clock::time_point due) {
  std::this_thread::sleep_until(due);
  return true;
}

PlaySummary play_file(const std::string& path, const PlayOptions& options,
                      const SleepUntil& sleep = sleep_until) {
  SourceState state;
  const auto recording = PcapReader::open(path, std::nullopt, state);
  REQUIRE(recording);
  auto sender = UdpSender::open("127.0.0.1");
  REQUIRE(sender);
  const auto summary = play(**recording, *sender, options, sleep);
  REQUIRE(summary);
  return *summary;
}

}  // namespace

TEST_CASE("payloads arrive whole, in order, fragmented ones put together") {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/some.pcap";
  const std::vector<Bytes> payloads = {counting(1206, 1), counting(4000, 2), counting(48, 3)};
  {
    PcapFile file(path);
    file.datagram(0, 2368, payloads[0]);
    file.fragmented(1000, 2368, payloads[1]);
    file.datagram(2000, 8308, payloads[2]);
  }
  const Listener listener;
  PlayOptions options;
  options.port = listener.port();
  const PlaySummary summary = play_file(path, options);
  CHECK(listener.received(3) == payloads);
  CHECK(summary.packets == 3);
  CHECK(summary.bytes == 1206 + 4000 + 48);
  CHECK(summary.failed == 0);
}

TEST_CASE("a mapped port takes its payloads and leaves the others out") {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/some.pcap";
  {
    PcapFile file(path);
    for (std::uint8_t i = 0; i < 4; ++i) file.datagram(i, i % 2 == 0 ? 7502 : 7503, counting(100, i));
  }
  const Listener listener;
  PlayOptions options;
  options.mapped_ports = {{7502, listener.port()}};
  const PlaySummary summary = play_file(path, options);
  CHECK(listener.received(2) == std::vector<Bytes>{counting(100, 0), counting(100, 2)});
  CHECK(summary.left_out == 2);
}

TEST_CASE("the pace is the recorded one times the rate") {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/some.pcap";
  {
    PcapFile file(path);
    for (std::uint32_t i = 0; i < 5; ++i) file.datagram(i * 100'000, 2368, counting(10, 0));
  }
  const Listener listener;
  PlayOptions options;
  options.port = listener.port();
  options.rate = 4.0;
  std::vector<std::chrono::steady_clock::time_point> deadlines;
  play_file(path, options, [&](auto due) {
    deadlines.push_back(due);
    return true;
  });
  REQUIRE(deadlines.size() == 5);
  for (std::size_t i = 1; i < deadlines.size(); ++i)
    CHECK(deadlines[i] - deadlines[i - 1] == std::chrono::milliseconds(25));
}

TEST_CASE("a loop goes on until the stop, one gap after its end") {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/some.pcap";
  {
    PcapFile file(path);
    for (std::uint32_t i = 0; i < 3; ++i) file.datagram(i * 10'000, 2368, counting(10, 0));
  }
  const Listener listener;
  PlayOptions options;
  options.port = listener.port();
  options.loop = true;
  std::vector<std::chrono::steady_clock::time_point> deadlines;
  const PlaySummary summary = play_file(path, options, [&](auto due) {
    deadlines.push_back(due);
    return deadlines.size() <= 7;
  });
  CHECK(summary.packets == 7);
  CHECK(summary.passes == 2);
  for (std::size_t i = 1; i < deadlines.size(); ++i)
    CHECK(deadlines[i] - deadlines[i - 1] == std::chrono::milliseconds(10));
}

TEST_CASE("a host that is none is an error that names it") {
  const auto sender = UdpSender::open("no.such.host.invalid");
  REQUIRE(!sender);
  CHECK(sender.error().find("no.such.host.invalid") != std::string::npos);
}

TEST_CASE("a multicast group and an IPv6 address get packets as an IPv4 address does") {
  const auto sent_and_come = [](const gvom::ingest::UdpOptions& where, const std::string& host,
                                const std::string& interface) {
    gvom::ingest::SourceState state;
    const auto receiver = gvom::ingest::UdpReceiver::open(where, state);
    REQUIRE(receiver);
    auto sender = UdpSender::open(host, interface);
    REQUIRE(sender);
    const Bytes bytes{1, 2, 3};
    REQUIRE(sender->send(bytes.data(), bytes.size(), where.port));
    gvom::ingest::Packet packet;
    const auto event = (*receiver)->next(packet, std::chrono::seconds(5));
    return event && *event == gvom::ingest::PacketEvent::packet &&
           Bytes(packet.data, packet.data + packet.size) == bytes;
  };
  const auto port = static_cast<std::uint16_t>(20000 + ::getpid() % 20000);
  const auto group = gvom::ingest::parse_address("239.201.201.201");
  CHECK(sent_and_come({port, {}, group, "lo"}, "239.201.201.201", "lo"));
  CHECK_FALSE(UdpSender::open("239.201.201.201", "no-such0"));
  if (std::ifstream("/proc/net/if_inet6").peek() == std::ifstream::traits_type::eof()) {
    WARN("SKIPPED: no IPv6 on this machine");
    return;
  }
  CHECK(sent_and_come({port, gvom::ingest::parse_address("::1"), {}, ""}, "::1", ""));
}
