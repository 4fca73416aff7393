// Whose clock a source's stamps are of: lidars.NAME.clock and clock_offset_s.
#include <cmath>

#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;

namespace {

constexpr std::int64_t kUnix_ns = 1'700'000'000'000'000'000;

/// Ten turns of a sensor that counts from its boot, whose packets come as soon as they are sent, but each
/// third by a millisecond later.
std::string recording(const std::string& folder) {
  PcapWriter pcap(folder + "/boot.pcap");
  const OusterSensor sensor;
  for (int turn = 0; turn < 10; ++turn)
    for (int first = 0; first < 16; first += 4)
      pcap.add(frame(plain_packet(sensor, turn, first)),
               kUnix_ns + column_time_ns(turn, first + 3) + (first == 8 ? 1'000'000 : 0));
  return "ouster:" + pcap.write() + "?meta=" + write_text(folder + "/meta.json", sensor.json());
}

}  // namespace

TEST_CASE("with clock: arrival the times are those at which packets came, exact within the sweep") {
  const TemporaryFolder folder;
  const std::string uri = recording(folder.path());
  const auto own = all_sweeps(*open(uri, {0.5, 1000}));
  const auto source = open(uri, {0.5, 1000, true, -2'000'000'000});
  const auto arrived = all_sweeps(*source);
  REQUIRE(own.size() == 10);
  REQUIRE(arrived.size() == 10);
  for (std::size_t i = 0; i < own.size(); ++i) {
    CHECK(arrived[i].stamp_ns == own[i].stamp_ns + kUnix_ns - 2'000'000'000);
    for (std::size_t k = 0; k < own[i].times_ns.size(); ++k)
      CHECK(arrived[i].times_ns[k] == own[i].times_ns[k] + kUnix_ns - 2'000'000'000);
  }
  REQUIRE(source->rewind());
  CHECK(all_sweeps(*source).front().stamp_ns == arrived.front().stamp_ns);
}

TEST_CASE("clock_offset_s is added to the stamps of packets and of scans") {
  const TemporaryFolder folder;
  const std::string uri = recording(folder.path());
  const auto own = all_sweeps(*open(uri, {0.5, 1000}));
  const auto moved = all_sweeps(*open(uri, {0.5, 1000, false, 37'000'000'000}));
  REQUIRE(moved.size() == own.size());
  CHECK(moved[3].stamp_ns == own[3].stamp_ns + 37'000'000'000);
  CHECK(moved[3].times_ns[0] == own[3].times_ns[0] + 37'000'000'000);

  const std::string bin = folder.path() + "/one.bin";
  write_text(bin, std::string(32, '\0'));
  const auto scans = all_sweeps(*open("scans:" + bin, {0.5, 1000, false, 5}));
  REQUIRE(scans.size() == 1);
  CHECK(scans[0].stamp_ns == 5);
  CHECK(scans[0].times_ns[0] == 5);
}

TEST_CASE("scans have no times of arrival, so clock: arrival is refused") {
  const TemporaryFolder folder;
  write_text(folder.path() + "/one.bin", std::string(32, '\0'));
  const auto source = ingest::open_source("scans:" + folder.path() + "/one.bin", {0.5, 1000, true});
  REQUIRE_FALSE(source);
  CHECK_THAT(source.error().what, Catch::Contains("clock: arrival needs packets"));
}
