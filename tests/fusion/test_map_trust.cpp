// Which maps fusion does not believe, whatever their publisher says.
#include <catch2/catch.hpp>

#include <cstdint>
#include <limits>

#include "services/fusion/map_trust.hpp"

using namespace gvom;
using Catch::Matchers::Contains;
using fusion::MapLie;
using fusion::MapTrust;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kNow_ns = 500 * kSecond_ns;
constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();

ipc::BrickMap map_of(std::uint64_t epoch, std::int64_t stamp_ns) {
  ipc::BrickMap map{};
  map.header.epoch = epoch;
  map.header.stamp_ns = stamp_ns;
  map.mono_received_ns = kNow_ns - kSecond_ns / 10;
  return map;
}

ipc::MessageHeader odometry_of(std::uint64_t epoch, std::int64_t stamp_ns) {
  ipc::MessageHeader header{};
  header.epoch = epoch;
  header.stamp_ns = stamp_ns;
  return header;
}

MapTrust with_odometry(std::uint64_t epoch, std::int64_t stamp_ns) {
  MapTrust trust;
  trust.take(odometry_of(epoch, stamp_ns));
  return trust;
}

}  // namespace

TEST_CASE("maps of what the odometry has announced are believed") {
  const MapTrust trust = with_odometry(7, 10 * kSecond_ns);
  CHECK_FALSE(trust.judge(map_of(7, 10 * kSecond_ns), kNow_ns));
  CHECK_FALSE(trust.judge(map_of(7, 1), kNow_ns));
  CHECK_FALSE(trust.judge(map_of(6, 100 * kSecond_ns), kNow_ns));  // of the clock before: for others to drop
}

TEST_CASE("an epoch that no odometry announced is a lie, however far ahead it is") {
  const MapTrust trust = with_odometry(7, 10 * kSecond_ns);
  for (const std::uint64_t epoch : {std::uint64_t{8}, std::uint64_t{1} << 62, kMost}) {
    const auto lie = trust.judge(map_of(epoch, kSecond_ns), kNow_ns);
    REQUIRE(lie);
    CHECK(lie->about == MapLie::About::epoch);
    CHECK(lie->why == "map refused: its epoch " + std::to_string(epoch) + " was announced by no odometry");
  }
}

TEST_CASE("a new epoch is believed once the odometry has announced it, and old odometry changes nothing") {
  MapTrust trust = with_odometry(7, 10 * kSecond_ns);
  trust.take(odometry_of(8, kSecond_ns));
  trust.take(odometry_of(3, 99 * kSecond_ns));
  CHECK_FALSE(trust.judge(map_of(8, kSecond_ns), kNow_ns));
  CHECK(trust.judge(map_of(8, 9 * kSecond_ns), kNow_ns));  // the new clock is at 1 s
}

TEST_CASE(
    "a clock that was set back is believed after eight messages, however often, and maps ahead of it are "
    "not") {
  MapTrust trust;
  std::uint64_t sequence = 0;
  const auto hear = [&](std::int64_t stamp_ns) {
    auto header = odometry_of(7, stamp_ns);
    header.sequence = ++sequence;
    trust.take(header);
  };
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 8; ++i) {
      hear(kSecond_ns + i);  // from the second round on the clock went back
      if (round > 0) CHECK(trust.was_deceived() == (i == 7));
    }
    if (trust.was_deceived()) trust.forget();
    CHECK(trust.judge(map_of(7, 100 * kSecond_ns), kNow_ns));
    hear(100 * kSecond_ns);
    CHECK_FALSE(trust.judge(map_of(7, 100 * kSecond_ns), kNow_ns));
    trust.believe(map_of(7, 100 * kSecond_ns));
    CHECK_FALSE(trust.was_deceived());
  }
}

TEST_CASE("strays of the past are none, and of messages that fusion did not see the others count") {
  MapTrust trust;
  auto header = odometry_of(7, 100 * kSecond_ns);
  trust.take(header);
  trust.believe(map_of(7, 100 * kSecond_ns));
  for (int i = 0; i < 100; ++i) {
    header.stamp_ns = i % 7 == 6 ? 100 * kSecond_ns + i : kSecond_ns;  // six strays, and one that goes on
    ++header.sequence;
    trust.take(header);
    REQUIRE_FALSE(trust.was_deceived());
  }
  header.stamp_ns = kSecond_ns;
  ++header.sequence;
  trust.take(header);
  CHECK_FALSE(trust.was_deceived());
  header.sequence += 7;  // six between them were never taken
  trust.take(header);
  CHECK(trust.was_deceived());
}

TEST_CASE("a jump of the odometry after the map's own stamp is a lie") {
  const MapTrust trust = with_odometry(7, 10 * kSecond_ns);
  ipc::BrickMap map = map_of(7, 9 * kSecond_ns);
  map.odometry_jump_ns = map.header.stamp_ns;
  CHECK_FALSE(trust.judge(map, kNow_ns));
  for (const std::int64_t ahead_ns : {std::int64_t{1}, 3'000'000'000 * kSecond_ns}) {
    map.odometry_jump_ns = map.header.stamp_ns + ahead_ns;
    const auto lie = trust.judge(map, kNow_ns);
    REQUIRE(lie);
    CHECK(lie->about == MapLie::About::time);
    CHECK_THAT(lie->why, Contains("the odometry is to jump"));
  }
}

TEST_CASE("a stamp that the odometry is far from is a lie") {
  const MapTrust trust = with_odometry(7, 10 * kSecond_ns);
  CHECK_FALSE(trust.judge(map_of(7, 11 * kSecond_ns), kNow_ns));  // its pose may still be on the way
  const auto lie = trust.judge(map_of(7, 60 * kSecond_ns), kNow_ns);
  REQUIRE(lie);
  CHECK(lie->why == "map refused: its stamp is 50.0 s ahead of the odometry");
}

TEST_CASE("packets that came at no time, or are to come, are a lie") {
  const MapTrust trust = with_odometry(7, 10 * kSecond_ns);
  ipc::BrickMap map = map_of(7, 10 * kSecond_ns);
  for (const std::int64_t received_ns : {std::int64_t{0}, std::int64_t{-1}, kNow_ns + 1}) {
    map.mono_received_ns = received_ns;
    CHECK(trust.judge(map, kNow_ns));
  }
}

TEST_CASE("without odometry the first map's epoch holds, until odometry contradicts it") {
  MapTrust trust;
  CHECK_FALSE(trust.judge(map_of(7, 10 * kSecond_ns), kNow_ns));
  trust.believe(map_of(7, 10 * kSecond_ns));
  CHECK_FALSE(trust.judge(map_of(7, 11 * kSecond_ns), kNow_ns));
  CHECK(trust.judge(map_of(kMost, 11 * kSecond_ns), kNow_ns));
  CHECK_FALSE(trust.was_deceived());

  trust.take(odometry_of(7, 10 * kSecond_ns));
  CHECK_FALSE(trust.was_deceived());
  trust.believe(map_of(kMost, 0));
  CHECK(trust.was_deceived());
  trust.forget();
  CHECK_FALSE(trust.was_deceived());
  trust.believe(map_of(7, 60 * kSecond_ns));
  CHECK(trust.was_deceived());
}

TEST_CASE("a jump of the odometry is believed once the odometry has come to it") {
  MapTrust trust = with_odometry(7, 10 * kSecond_ns);
  ipc::BrickMap map = map_of(7, 10 * kSecond_ns + kSecond_ns / 2);
  map.odometry_jump_ns = 10 * kSecond_ns + kSecond_ns / 4;
  const auto lie = trust.judge(map, kNow_ns);
  REQUIRE(lie);
  CHECK(lie->about == MapLie::About::time);
  CHECK_THAT(lie->why, Contains("the odometry is to jump 0.2 s after what is heard of it"));
  trust.take(odometry_of(7, map.odometry_jump_ns));
  CHECK_FALSE(trust.judge(map, kNow_ns));
}
