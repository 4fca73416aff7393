#include <cstring>
#include <string>
#include <thread>

#include "services/common/dds/reader.hpp"
#include "tests/common/temporary_file.hpp"
#include "tests/dds/cdr_bytes.hpp"
#include "tests/dds/message_file.hpp"
#include "tests/dds/network.hpp"
#include "tests/dds/peer_process.hpp"

using namespace gvom::dds;
using namespace gvom::dds::test;
using namespace std::chrono_literals;

namespace {

const Topic kCloud{"/ouster/points", "sensor_msgs/msg/PointCloud2", ""};

Reader open(const std::shared_ptr<Participant>& participant) {
  auto reader = Reader::open(participant, kCloud);
  REQUIRE(reader);
  return std::move(*reader);
}

std::int32_t second_of(const Message& message) {
  std::int32_t second = 0;
  std::memcpy(&second, message.cdr->data() + 4, sizeof second);
  return second;
}

/// The octets that end the message, before its last field and what it is padded with.
std::uint64_t sum_of_cloud(const Message& message, std::size_t bytes) {
  // head 4, stamp 8, frame 4 + 10 + 2, height, width 8, no fields 4, bigendian 1 + 3, steps 8, count 4
  const auto begin = message.cdr->begin() + 4 + 8 + 16 + 8 + 4 + 4 + 8 + 4;
  REQUIRE(message.cdr->size() > static_cast<std::size_t>(begin - message.cdr->begin()) + bytes);
  return sum_of(Bytes(begin, begin + static_cast<std::ptrdiff_t>(bytes)));
}

std::string sent_line(const Message& message, std::size_t bytes) {
  return "sent " + std::to_string(second_of(message)) + ", sum " +
         std::to_string(sum_of_cloud(message, bytes));
}

/// Both know of each other: before, what is sent has no receiver.
void meet(Reader& reader, Peer& driver, int publishers) {
  REQUIRE(driver.line("matched") == "matched 1");
  for (int i = 0; i < 400 && reader.publishers() != publishers; ++i) reader.take(50ms);
  REQUIRE(reader.publishers() == publishers);
}

}  // namespace

TEST_CASE("clouds of 3.8 MB of a best-effort driver come in whole") {
  if (!has_large_buffers()) return;
  Reader reader = open(join(11));
  Peer driver({"11", "send-cloud", "/ouster/points", std::to_string(kCloudBytes / 32)});
  meet(reader, driver, 1);
  std::int64_t before_ns = 0;
  for (int number = 0; number < 8; ++number) {
    driver.go();
    const auto message = reader.take(20s);
    REQUIRE(message);
    CHECK(driver.line("sent") == sent_line(*message, kCloudBytes));
    CHECK(message->arrived_ns > before_ns);
    before_ns = message->arrived_ns;
  }
  CHECK(reader.counters().received == 8);
  CHECK(reader.counters().replaced == 0);
  CHECK(reader.counters().lost == 0);
}

TEST_CASE("of messages that are not taken the newest five are kept, and the others counted") {
  Reader reader = open(join(12));
  Peer driver({"12", "send-cloud", "/ouster/points", "10"});
  meet(reader, driver, 1);
  for (int number = 0; number < 12; ++number) {
    driver.go();
    REQUIRE_FALSE(driver.line("sent").empty());
  }
  for (int i = 0; i < 400 && reader.counters().received < 12; ++i) std::this_thread::sleep_for(50ms);
  CHECK(reader.counters().received == 12);
  CHECK(reader.counters().replaced == 7);
  for (int number = 7; number < 12; ++number) {
    const auto message = reader.take(0ms);
    REQUIRE(message);
    CHECK(second_of(*message) == number);
  }
  CHECK_FALSE(reader.take(0ms));
}

TEST_CASE("what gets lost on the way is counted when a later message comes") {
  const gvom::test::TemporaryFile small_buffer(
      "<CycloneDDS><Domain><Internal><SocketReceiveBufferSize "
      "max=\"16kB\"/></Internal></Domain></CycloneDDS>");
  ParticipantOptions options;
  options.domain = {14, "lo", {}, small_buffer.path()};
  Reader reader = open(Participant::open(options).value());
  const auto cloud = [](std::size_t bytes) {
    return gvom::test::cloud_message(0, {{}, 32}, gvom::test::Octets(bytes));
  };
  constexpr int kLarge = 4, kMost = 400;
  MessageFile clouds(kCloud.type);
  for (int i = 0; i < kMost; ++i) clouds.add(cloud(i > 0 && i <= kLarge ? kCloudBytes : 32));
  Peer driver(clouds.sender(14, kCloud.name));
  meet(reader, driver, 1);
  std::uint64_t sent = 0;
  const auto all_seen = [&] { return reader.counters().received + reader.counters().lost == sent; };
  while (sent < kMost && (sent <= kLarge || !all_seen())) {  // a small one may find the buffer full, too
    driver.go();
    REQUIRE(driver.line("sent") == "sent");
    ++sent;
    for (int i = 0; i < 10 && !all_seen(); ++i) std::this_thread::sleep_for(5ms);
  }
  CHECK(all_seen());
  CHECK(reader.counters().lost > 0);
}

TEST_CASE("each publisher of a topic can be told from the others") {
  Reader reader = open(join(13));
  Peer front({"13", "send-cloud", "/ouster/points", "10"});
  meet(reader, front, 1);
  Peer rear({"13", "send-cloud", "/ouster/points", "20"});
  meet(reader, rear, 2);
  const auto of = [&](const Peer& peer) {
    peer.go();
    const auto message = reader.take(20s);
    REQUIRE(message);
    return message->publisher;
  };
  const std::uint64_t of_front = of(front);
  const std::uint64_t of_rear = of(rear);
  CHECK(of_front != of_rear);
  CHECK(of(front) == of_front);
  CHECK(of(rear) == of_rear);
}
