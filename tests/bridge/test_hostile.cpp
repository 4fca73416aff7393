// Strangers at a running bridge: many, slow, silent and hostile ones. Its clients, its memory and fusion bear
// it.
#include <atomic>
#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <thread>

#include "ipc/text.hpp"
#include "services/bridge/foxglove_server.hpp"
#include "tests/bridge/bridge_rig.hpp"
#include "tests/bridge/stranger.hpp"
#include "tests/processes/observer.hpp"

namespace {

using namespace gvom;
using ipc::test::eventually;
using test::Rig;
using test::Stranger;
using test::WsClient;

constexpr std::uint32_t kCostmap = 1, kChannels = 10;
constexpr std::size_t kReaders = 10;
constexpr const char* kBridge = "gvom-bridge";
/// 16 clients with the largest message of this map under way (0.75 MB) are 12 MB; the rest is for chunks of
/// the bus that it had not read before, and the allocator.
constexpr long kMostGrowth_kb = 48 << 10;

std::unique_ptr<WsClient> subscribed_to_all(const Rig& rig) {
  auto client = rig.client();
  REQUIRE(client);
  for (std::uint32_t channel = 1; channel <= kChannels; ++channel)
    REQUIRE(client->subscribe(channel, channel));
  return client;
}

/// A client of everything that reads as fast as it can, in a thread of its own.
class Reader {
 public:
  explicit Reader(std::unique_ptr<WsClient> client)
      : client_(std::move(client)), thread_([this] { read(); }) {}
  ~Reader() {
    done_ = true;
    thread_.join();
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  [[nodiscard]] std::uint64_t costmaps() const { return costmaps_; }
  /// Of the last costmap.
  [[nodiscard]] std::int64_t stamp_ns() const { return stamp_ns_; }

 private:
  void read() {
    while (!done_) {
      const auto message = client_->read_data();
      if (!message) return;
      std::uint32_t channel;
      std::int64_t stamp_ns;
      std::memcpy(&channel, message->bytes.data() + 1, sizeof channel);
      std::memcpy(&stamp_ns, message->bytes.data() + 5, sizeof stamp_ns);
      if (channel != kCostmap) continue;
      stamp_ns_ = stamp_ns;
      ++costmaps_;
    }
  }

  std::unique_ptr<WsClient> client_;
  std::atomic<std::uint64_t> costmaps_{0};
  std::atomic<std::int64_t> stamp_ns_{0};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

/// The most that a process ever held.
long peak_memory_kb(const test::Program& program) {
  std::ifstream status("/proc/" + std::to_string(program.pid()) + "/status");
  std::string word;
  while (status >> word && word != "VmHWM:") {
  }
  long size_kb = 0;
  status >> size_kb;
  REQUIRE(size_kb > 0);
  return size_kb;
}

/// Becomes a client, and says that 100 MB follow.
void announce(const Stranger& stranger) {
  stranger.send(test::upgrade("Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n"));
  CHECK(stranger.gets_head());
  stranger.send(std::string("\x82\xff\x00\x00\x00\x00\x06\x40\x00\x00mask", 14));
}

void send_garbage(std::uint16_t port) {
  const Stranger stranger(port);
  stranger.send("\x16\x03\x01\x02 garbage\r\n\r\n");
  CHECK(stranger.is_closed());
}

void send_endless_head(std::uint16_t port) {
  const Stranger stranger(port);
  stranger.send("GET / HTTP/1.1\r\nX: ");
  for (int i = 0; i < 100 && stranger.send(std::string(100'000, 'x')); ++i) {
  }
  CHECK(stranger.is_closed());
}

void announce_100_mb(std::uint16_t port) {
  const Stranger stranger(port);
  announce(stranger);
  CHECK(stranger.is_closed());
}

void send_100_mb(std::uint16_t port) {
  const Stranger stranger(port);
  announce(stranger);
  const std::string part(1'000'000, 'x');
  for (int i = 0; i < 100 && stranger.send(part); ++i) {
  }
  CHECK(stranger.is_closed());
}

constexpr void (*kAttacks[])(std::uint16_t) = {send_garbage, send_endless_head, announce_100_mb, send_100_mb};

/// So many connections that say nothing that no more are taken.
void crowd(std::uint16_t port) {
  std::vector<std::unique_ptr<Stranger>> silent;
  for (std::size_t i = 0; i < bridge::kMostConnections; ++i)
    silent.push_back(std::make_unique<Stranger>(port));
  CHECK(eventually([&] { return silent.back()->is_closed_now(); }));
  CHECK(!silent.front()->is_closed_now());
}

/// Each reader gets costmaps, and at some moment has the one that is fusion's newest.
void must_be_up_to_date(const std::vector<std::unique_ptr<Reader>>& readers, const test::Observer& observer) {
  for (const auto& reader : readers) {
    const std::uint64_t before = reader->costmaps();
    CHECK(eventually([&] {
      return reader->costmaps() > before && reader->stamp_ns() == observer.newest_layers().header.stamp_ns;
    }));
  }
}

TEST_CASE("strangers of all kinds: the clients get the newest, memory is bounded, fusion does not notice") {
  // Seldom, so that each reader has time to hold the newest.
  Rig rig({"fusion.rate_hz=2", "fusion.voxel_rate_hz=2"});
  const test::Observer observer(rig.folder.path());
  REQUIRE(observer.is_up());
  rig.start();
  const auto idle = subscribed_to_all(rig);  // and never reads
  std::vector<std::unique_ptr<Reader>> readers;
  while (readers.size() < kReaders) readers.push_back(std::make_unique<Reader>(subscribed_to_all(rig)));
  const auto counted = [&](const char* name) {
    return observer.counter(kBridge, std::string("foxglove_") + name);
  };
  REQUIRE(eventually([&] { return counted("clients") == kReaders + 1 && counted("replaced") > 0; }));
  must_be_up_to_date(readers, observer);

  const long before_kb = peak_memory_kb(*rig.bridge);
  for (const auto attack : kAttacks) attack(rig.port);
  crowd(rig.port);
  must_be_up_to_date(readers, observer);
  const long after_kb = peak_memory_kb(*rig.bridge);
  INFO("before " << before_kb << " kB, after " << after_kb << " kB");
  CHECK(after_kb - before_kb < kMostGrowth_kb);

  const std::uint64_t refused = std::size(kAttacks) + kReaders + 1;  // the crowd's last found no room
  CHECK(eventually([&] { return counted("refused") >= refused; }));
  CHECK(eventually([&] { return counted("clients") == kReaders + 1; }));
  for (const char* want_of_room : {"drop_layers_no_chunk", "drop_voxels_no_chunk"})
    CHECK(observer.counter("gvom-fusion", want_of_room) == 0);
  readers.clear();
  CHECK(rig.bridge->stop() == 0);
  rig.end();
}

TEST_CASE("while its port is taken the bridge says so and records; when it is free its clients come") {
  Rig rig;
  const test::Observer observer(rig.folder.path());
  REQUIRE(observer.is_up());
  auto holder = std::make_optional<test::PortHolder>(rig.port);
  REQUIRE(holder->holds());
  rig.start();
  const std::string place = "cannot listen at 127.0.0.1:" + std::to_string(rig.port);
  const auto told = [&] {
    const auto health = observer.health(kBridge);
    return health && std::string(ipc::text_of(health->reason)).find(place) != std::string::npos;
  };
  REQUIRE(eventually(told));
  CHECK(observer.sees(kBridge, ipc::HealthState::degraded));
  CHECK(eventually([&] { return observer.counter(kBridge, "mcap_sent") > 0; }));
  holder.reset();
  const auto client = rig.client();
  REQUIRE(client);
  REQUIRE(client->subscribe(kCostmap, kCostmap));
  CHECK(client->read_data());
  CHECK(observer.sees(kBridge, ipc::HealthState::ok));
  CHECK(rig.bridge->stop() == 0);
  rig.end();
}

}  // namespace
