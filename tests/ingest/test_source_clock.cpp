// Whose clock a source's stamps are of: lidars.NAME.clock and clock_offset_s.
#include <cmath>
#include <memory>

#include "services/ingest/ouster_decoder.hpp"
#include "services/ingest/packet_sweep_source.hpp"
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

/// A small sensor on the network, ten turns a second. From `set_at_turn` on the wall clock is `set_by_ns`
/// ahead of what it was; the machine was suspended for a second until then.
class Wire final : public ingest::PacketSource {
 public:
  Wire(int turns, int set_at_turn, std::int64_t set_by_ns)
      : turns_(turns), set_at_turn_(set_at_turn), set_by_ns_(set_by_ns) {}

  tl::expected<ingest::PacketEvent, std::string> next(ingest::Packet& out,
                                                      std::chrono::milliseconds) override {
    if (turn_ == turns_) return ingest::PacketEvent::end;
    bytes_ = plain_packet(sensor_, turn_, column_);
    const bool set = turn_ >= set_at_turn_;
    out.data = bytes_.data();
    out.size = bytes_.size();
    out.received_ns = sensor_.column_time_ns(turn_, column_ + 3);
    out.capture_ns = kUnix_ns + out.received_ns + (set ? set_by_ns_ : 0);
    out.suspended_ns = set ? 1'000'000'000 : 0;
    column_ = (column_ + 4) % sensor_.columns;
    if (column_ == 0) ++turn_;
    return ingest::PacketEvent::packet;
  }
  tl::expected<void, std::string> rewind() override { return {}; }
  [[nodiscard]] bool is_live() const override { return true; }

 private:
  const OusterSensor sensor_;
  const int turns_, set_at_turn_;
  const std::int64_t set_by_ns_;
  int turn_ = 0, column_ = 0;
  ByteVector bytes_;
};

std::vector<Sweep> live_sweeps(std::unique_ptr<Wire> wire, const ingest::SourceOptions& options) {
  const TemporaryFolder folder;
  auto state = std::make_unique<ingest::SourceState>();
  auto metadata = ingest::read_ouster_metadata(
      write_text(folder.path() + "/meta.json", OusterSensor{}.json()), state->warnings);
  REQUIRE(metadata);
  auto decoder = std::make_unique<ingest::OusterDecoder>(std::move(*metadata), options, *state);
  ingest::PacketSweepSource source(std::move(state), std::move(wire), std::move(decoder), options);
  return all_sweeps(source);
}

}  // namespace

TEST_CASE("a wall clock that is set by a little is no delay of the network: the sweeps follow it") {
  constexpr std::int64_t kStep_ns = 200'000'000;
  const auto sweeps = live_sweeps(std::make_unique<Wire>(60, 40, kStep_ns), {0.5, 1000, true});
  REQUIRE(sweeps.size() > 40);
  const auto ahead_ns = [&](const Sweep& sweep) { return sweep.stamp_ns - kUnix_ns - sweep.received_ns; };
  CHECK(ahead_ns(sweeps[sweeps.size() - 25]) == 0);
  CHECK(ahead_ns(sweeps.back()) == kStep_ns);
  CHECK(ahead_ns(sweeps[sweeps.size() - 15]) == kStep_ns);  // half a second after it
}

TEST_CASE("a sweep knows how long the machine had been suspended when its packets came") {
  const auto sweeps = live_sweeps(std::make_unique<Wire>(30, 20, 0), {0.5, 1000});
  REQUIRE(sweeps.size() > 12);
  CHECK(sweeps[sweeps.size() - 11].suspended_ns == 0);
  CHECK(sweeps[sweeps.size() - 10].suspended_ns == 1'000'000'000);
}

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
