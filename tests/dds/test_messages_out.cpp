#include <signal.h>

#include <string>
#include <thread>

#include "services/common/dds/writer.hpp"
#include "tests/dds/cdr_bytes.hpp"
#include "tests/dds/network.hpp"
#include "tests/dds/peer_process.hpp"

using namespace gvom::dds;
using namespace gvom::dds::test;

namespace {

const Topic kCostmap{"/gvom/costmap", "nav_msgs/msg/OccupancyGrid", ""};
const Topic kPoints{"/gvom/points", "sensor_msgs/msg/PointCloud2", ""};
constexpr Qos kLatest{true, true, 1};
constexpr Qos kLive{true, false, 1};

Writer open(const std::shared_ptr<Participant>& participant, const Topic& topic, const Qos& qos) {
  auto writer = Writer::open(participant, topic, qos);
  REQUIRE(writer);
  return std::move(*writer);
}

/// Both know of each other: before, what is sent has no receiver.
void meet(const Writer& writer, Peer& peer, int readers) {
  REQUIRE(peer.line("matched") == "matched 1");
  for (int i = 0; i < 400 && writer.subscribers() != readers; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  REQUIRE(writer.subscribers() == readers);
}

Bytes cloud_bytes(int number) {
  Bytes bytes(kCloudBytes);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::uint8_t>(i % 251 + static_cast<std::size_t>(number));
  return bytes;
}

std::string cloud_line(int number) {
  return "cloud " + std::to_string(kCloudBytes / 32) + " of " + std::to_string(kCloudBytes) + " bytes at " +
         std::to_string(number) + ", sum " + std::to_string(sum_of(cloud_bytes(number)));
}

/// One after the other has it, so that no message stands in another's way.
void send_and_hear(Writer& writer, Peer& peer, int number) {
  REQUIRE(writer.write(cloud_message(number, cloud_bytes(number))));
  CHECK(peer.line("cloud") == cloud_line(number));
}

}  // namespace

TEST_CASE("a reader that comes late gets the newest costmap, whatever its size") {
  Writer writer = open(join(1), kCostmap, kLatest);
  for (const std::uint32_t cells :
       {5U, 6U, 7U, 8U, 256U}) {  // messages of 1, 2, 3 and no bytes beyond a word
    Bytes cost(cells * 5, 100);
    cost.back() = 255;
    REQUIRE(writer.write(grid_message(1, 1, Bytes(1))));
    REQUIRE(writer.write(grid_message(cells, 5, cost)));
    Peer late({"1", "hear-grid", "/gvom/costmap"});
    CHECK(late.line("grid") == "grid " + std::to_string(cells) +
                                   " x 5 of 0.25 m at 7.500000000 in odom, cost " +
                                   std::to_string(sum_of(cost)));
  }
}

TEST_CASE("clouds of 3.8 MB come whole and in order") {
  if (!has_large_buffers()) return;
  Writer writer = open(join(2), kPoints, kLive);
  Peer peer({"2", "hear-cloud", "/gvom/points"});
  meet(writer, peer, 1);
  for (int number = 0; number < 8; ++number) send_and_hear(writer, peer, number);
}

TEST_CASE("a reader that stopped, and one that was killed, hold up nobody") {
  if (!has_large_buffers()) return;
  Writer writer = open(join(3), kPoints, kLive);
  Peer killed({"3", "hear-cloud", "/gvom/points"});
  meet(writer, killed, 1);
  Peer stopped({"3", "hear-cloud", "/gvom/points"});
  meet(writer, stopped, 2);
  Peer well({"3", "hear-cloud", "/gvom/points"});
  meet(writer, well, 3);
  send_and_hear(writer, well, 0);
  CHECK(killed.line("cloud") == cloud_line(0));
  CHECK(stopped.line("cloud") == cloud_line(0));

  killed.send(SIGKILL);
  stopped.send(SIGSTOP);
  for (int number = 1; number < 5; ++number) send_and_hear(writer, well, number);
  stopped.send(SIGCONT);
  // What it missed was replaced by the newest, and comes with that, or is lost.
  std::string last;
  do last = stopped.line("cloud");
  while (!last.empty() && last != cloud_line(4));
  CHECK(last == cloud_line(4));
}

TEST_CASE("what is no message is refused") {
  Writer writer = open(join(4), kCostmap, kLatest);
  CHECK(writer.write(nullptr).error() == "a message without its head of four bytes");
  CHECK(writer.write(std::make_shared<const Bytes>(3)).error() == "a message without its head of four bytes");
  CHECK(writer.write(std::make_shared<const Bytes>(kLargestMessage + 1)).error() ==
        "a message of 67108865 bytes, more than 67108864");
  CHECK(writer.write(std::make_shared<const Bytes>(4)));
  CHECK(writer.subscribers() == 0);
}
