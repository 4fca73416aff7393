// Velodyne packets to sweeps: geometry, turns, packets out of order, the hour.
#include <cstring>

#include "services/ingest/hour_clock.hpp"
#include "tests/ingest/velodyne_builder.hpp"

using namespace gvom;
using namespace gvom::test;
using namespace gvom::ingest;

namespace {

constexpr std::int64_t kHourNs = 3'600'000'000'000;

}  // namespace

TEST_CASE("azimuth 0 is forward, 90 degrees is right") {
  check_polar(one_return("VLP-16", {0, 0, 5000}, 0, 0x22), 10, 0, -15);
  check_polar(one_return("VLP-16", {9000, 1, 5000}, 0, 0x22), 10, 90, 1);
  CHECK(one_return("VLP-16", {9000, 1, 5000}, 0, 0x22).y_m < -9.9);
}

TEST_CASE("a laser that fires later in the block points further on") {
  // VLP-16: measurement 31 is laser 15 of the second firing: 55.296 + 15 * 2.304 of 110.592 us.
  check_polar(one_return("VLP-16", {1000, 31, 5000}, 40, 0x22), 10, 10 + 0.4 * (55.296 + 34.56) / 110.592,
              15);
  // HDL-32: laser 31 of 32, 1.152 us each, blocks of 46.08 us.
  check_polar(one_return("HDL-32", {1000, 31, 5000}, 20, 0x21), 10, 10 + 0.2 * 31 * 1.152 / 46.08, 10.67);
  // VLP-32C: lasers fire in pairs; 4 mm units; laser 2 is 1.4 degrees ahead, laser 3 is as much behind.
  check_polar(one_return("VLP-32C", {1000, 2, 5000}, 20, 0x28), 20, 10 + 0.2 * 2.304 / 55.296 + 1.4, -1.667);
  check_polar(one_return("VLP-32C", {1000, 3, 5000}, 20, 0x28), 20, 10 + 0.2 * 2.304 / 55.296 - 1.4, -15.639);
}

TEST_CASE("sweeps are cut where the azimuth passes through 0; a whole turn is complete") {
  const auto played = play(turn(3));
  REQUIRE(played.sweeps.size() == 3);
  CHECK(played.sweeps[0].complete);
  CHECK(played.sweeps[1].complete);
  CHECK(played.sweeps[1].returns.size() == Approx(904.5).margin(0.6));
  CHECK(played.sweeps[1].times_ns.front() - played.sweeps[0].times_ns.back() ==
        Approx(110592 / 2).margin(1000));
}

TEST_CASE("a missing packet makes a turn incomplete") {
  auto packets = turn(2);
  packets.erase(packets.begin() + 30);
  const auto played = play(packets);
  REQUIRE(played.sweeps.size() == 2);
  CHECK_FALSE(played.sweeps[0].complete);
  CHECK(played.sweeps[0].columns_seen_fraction == Approx(1 - 12 / 904.5).margin(0.002));
  CHECK(played.sweeps[0].returns.size() == Approx(904.5 - 12).margin(0.6));
  CHECK(played.sweeps[1].complete);
  CHECK(played.sweeps[1].columns_seen_fraction == 1);
}

TEST_CASE("less than half a turn is dropped") {
  auto packets = turn(1);
  packets.resize(packets.size() * 2 / 5);
  const auto played = play(packets);
  CHECK(played.sweeps.empty());
  CHECK(played.counters.dropped_sweeps == 1);
}

TEST_CASE("a packet out of order is used, one that comes twice is not, one of the turn before is late") {
  auto packets = turn(2);
  std::swap(packets[10], packets[11]);
  packets.insert(packets.begin() + 20, packets[19]);
  const auto played = play(packets);
  REQUIRE(played.sweeps.size() == 2);
  CHECK(played.sweeps[0].complete);
  CHECK(played.sweeps[0].returns.size() == Approx(904.5).margin(0.6));
  CHECK(played.counters.out_of_order_packets == 1);
  CHECK(played.counters.duplicate_packets == 1);

  packets = turn(2);
  const ByteVector delayed = packets[50];
  packets.erase(packets.begin() + 50);
  packets.insert(packets.begin() + 80, delayed);
  CHECK(play(packets).counters.late_packets == 1);
}

TEST_CASE("dual return mode: pairs of blocks are one shot; the second counts if it differs") {
  std::vector<Shot> blocks;
  for (int pair = 0; pair < 6; ++pair) {
    blocks.push_back({1000 + pair * 40, 1, 5000});
    blocks.push_back({1000 + pair * 40, 1, pair == 0 ? 6000 : pair == 1 ? 0 : 5000});
  }
  const auto played = play({velodyne_packet(blocks, 0, 0x39)}, "VLP-16", 0.0);
  REQUIRE(played.sweeps.size() == 1);
  REQUIRE(played.sweeps[0].returns.size() == 7);
  CHECK(played.sweeps[0].times_ns.size() == 12);
  check_polar(played.sweeps[0].returns[0], 10, 10 + 0.4 * 2.304 / 110.592, 1);
  check_polar(played.sweeps[0].returns[1], 12, 10 + 0.4 * 2.304 / 110.592, 1);
  CHECK(played.sweeps[0].returns[0].time_index == played.sweeps[0].returns[1].time_index);
  CHECK(played.sweeps[0].times_ns[2] - played.sweeps[0].times_ns[0] == 110592);
}

TEST_CASE("the hour is the capture's, also around the full hour") {
  const std::int64_t hour = 400'000 * kHourNs;
  const auto before = play(turn(1, 3'599'950'000), "VLP-16", 0.5, hour + 2'000'000'000);
  // The count of packets goes on past the hour here; a sensor's starts again.
  REQUIRE_FALSE(before.sweeps.empty());
  CHECK(before.sweeps[0].times_ns.front() == hour - 50'000'000);

  std::vector<ByteVector> packets;
  for (int block = 0; block < 905; block += 12) {
    const auto us = (3'599'950'000 + std::llround(block * 110.592)) % 3'600'000'000;
    ByteVector packet = turning_packet(block);
    const auto time_us = static_cast<std::uint32_t>(us);
    std::memcpy(packet.data() + 1200, &time_us, 4);
    packets.push_back(packet);
  }
  const auto across = play(packets, "VLP-16", 0.5, hour);
  REQUIRE(across.sweeps.size() == 1);
  CHECK(across.sweeps[0].complete);
  CHECK(across.sweeps[0].times_ns.front() == hour - 50'000'000);
  CHECK(across.sweeps[0].stamp_ns == Approx(hour + 50'000'000).margin(200'000));
}

TEST_CASE("live, the hour comes from the hint, and a hint that contradicts it changes it") {
  HourClock clock;
  CHECK(clock.full_time_ns(5, 0, 1000) == 5);
  CHECK(clock.is_hour_unknown());
  clock.hint(77 * kHourNs + 1'000'000'000);
  CHECK_FALSE(clock.is_hour_unknown());
  CHECK(clock.full_time_ns(1005, 0, 2000) == 77 * kHourNs + 1005);
  clock.hint(77 * kHourNs - 1'000'000'000);
  CHECK(clock.full_time_ns(2005, 0, 3000) == 77 * kHourNs + 2005);
  clock.hint(5 * kHourNs);
  CHECK(clock.full_time_ns(3005, 0, 4000) == 5 * kHourNs + 3005);
  // An hour and a second later, by this machine's clock.
  CHECK(clock.full_time_ns(1'000'003'005, 0, kHourNs + 1'000'004'000) == 6 * kHourNs + 1'000'003'005);
}

TEST_CASE("packets that are not of the sensor are foreign; blocks that are broken are counted") {
  auto packets = turn(1);
  packets[3][0] = 0;                                 // no block flag
  packets.insert(packets.begin(), ByteVector(512));  // a position packet
  packets[10][100] = 0;                              // no flag of the second block
  packets[11][3] = 0xFF;                             // an azimuth of 652 degrees
  const auto played = play(packets);
  REQUIRE(played.sweeps.size() == 1);
  CHECK(played.counters.foreign_packets == 2);
  CHECK(played.counters.invalid_columns == 2);
  CHECK(played.sweeps[0].returns.size() == 904 + 1 - 12 - 2);
}

TEST_CASE("a recording that is played again and again is taken up again") {
  auto packets = turn(1);
  const auto again = packets;
  for (int i = 0; i < 3; ++i) packets.insert(packets.end(), again.begin(), again.end());
  const auto played = play(packets);
  CHECK(played.sweeps.size() == 4);
  CHECK(played.counters.packets == packets.size());
}
