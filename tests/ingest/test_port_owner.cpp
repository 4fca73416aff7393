// Whose a live port is, with packets at given times.
#include "services/ingest/ouster_decoder.hpp"
#include "services/ingest/packet_sweep_source.hpp"
#include "tests/ingest/ouster_builder.hpp"
#include "tests/ingest/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using ingest::SourceEvent;

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kFrameNs = 100 * kMs;

struct Arrival {
  std::int64_t at_ns;
  std::uint8_t host;
  ByteVector payload;
};

/// Packets as they came in, and then nothing more.
class Arrivals final : public ingest::PacketSource {
 public:
  explicit Arrivals(std::vector<Arrival> arrivals) : arrivals_(std::move(arrivals)) {
    std::stable_sort(arrivals_.begin(), arrivals_.end(),
                     [](const Arrival& a, const Arrival& b) { return a.at_ns < b.at_ns; });
  }
  tl::expected<ingest::PacketEvent, std::string> next(ingest::Packet& out,
                                                      std::chrono::milliseconds) override {
    if (next_ == arrivals_.size()) return ingest::PacketEvent::idle;
    const Arrival& arrival = arrivals_[next_++];
    out = ingest::Packet{};
    out.data = arrival.payload.data();
    out.size = arrival.payload.size();
    out.received_ns = arrival.at_ns;
    const std::uint8_t from[4] = {10, 0, 0, arrival.host};
    out.source = ingest::ipv4_address(from);
    return ingest::PacketEvent::packet;
  }
  tl::expected<void, std::string> rewind() override { return {}; }
  [[nodiscard]] bool is_live() const override { return true; }

 private:
  std::vector<Arrival> arrivals_;
  std::size_t next_ = 0;
};

/// 64 columns a turn in packets of 4, 10 turns a second.
OusterSensor sensor() {
  OusterSensor sensor;
  sensor.profile = "RNG19_RFL8_SIG16_NIR16";
  sensor.columns = 64;
  sensor.window = "[0, 63]";
  return sensor;
}

constexpr int kPackets = 16;

/// A sensor at 10.0.0.HOST that sees everything `host` metres away, from `begin_ms` to `end_ms`.
void live(std::vector<Arrival>& arrivals, std::uint8_t host, int begin_ms, int end_ms) {
  for (int packet = 0;; ++packet) {
    const std::int64_t at_ns = begin_ms * kMs + packet * kFrameNs / kPackets;
    if (at_ns >= end_ms * kMs) return;
    const int frame = 1 + static_cast<int>(at_ns / kFrameNs);
    arrivals.push_back(
        {at_ns, host,
         plain_packet(sensor(), frame, packet % kPackets * 4, 1000U * static_cast<std::uint32_t>(host))});
  }
}

/// Single packets each `period_ms`.
void stray(std::vector<Arrival>& arrivals, std::uint8_t host, int begin_ms, int end_ms, int period_ms) {
  for (int at_ms = begin_ms; at_ms < end_ms; at_ms += period_ms)
    arrivals.push_back({at_ms * kMs, host,
                        plain_packet(sensor(), 1 + at_ms / 100, at_ms / 7 % kPackets * 4,
                                     1000U * static_cast<std::uint32_t>(host))});
}

struct Outcome {
  std::vector<int> sweeps;  // by host: whole sweeps of it
  int partial = 0;
  ingest::SourceCounters counters;
};

/// Every sweep must be of one sensor only.
Outcome play(std::vector<Arrival> arrivals, double min_sweep_fraction = 0,
             const ingest::SourceOptions& options = {}) {
  TemporaryFolder folder;
  auto state = std::make_unique<ingest::SourceState>();
  const std::string meta = write_text(folder.path() + "/meta.json", sensor().json());
  auto metadata = ingest::read_ouster_metadata(meta, state->warnings);
  REQUIRE(metadata.has_value());
  auto decoder = std::make_unique<ingest::OusterDecoder>(
      *metadata, ingest::SourceOptions{min_sweep_fraction, 1000}, *state);
  ingest::PacketSweepSource source(std::move(state), std::make_unique<Arrivals>(std::move(arrivals)),
                                   std::move(decoder), options);
  Outcome outcome;
  outcome.sweeps.resize(10);
  Sweep sweep;
  // The hour: when its time is over it says that it is idle.
  while (source.next(sweep, std::chrono::hours(1)).value() == SourceEvent::kSweep) {
    REQUIRE_FALSE(sweep.returns.empty());
    const auto host = [](const Return& r) { return std::lround(std::hypot(r.x_m, r.y_m, r.z_m)); };
    const auto first = host(sweep.returns.front());
    for (const Return& r : sweep.returns) REQUIRE(host(r) == first);
    if (sweep.complete) ++outcome.sweeps[static_cast<std::size_t>(first)];
    if (!sweep.complete) ++outcome.partial;
  }
  outcome.counters = source.counters();
  return outcome;
}

}  // namespace

TEST_CASE("a sensor that is alone has its port from its first packet on") {
  std::vector<Arrival> arrivals;
  live(arrivals, 1, 1000, 3000);
  const Outcome outcome = play(arrivals);
  CHECK(outcome.sweeps[1] == 20);
  CHECK(outcome.partial == 0);
  CHECK(outcome.counters.packets == 20 * kPackets);
  CHECK(outcome.counters.second_sensor_packets == 0);
}

TEST_CASE("single packets from elsewhere, also before the sensor's first, do not keep it out") {
  for (const int period_ms : {500, 200, 100, 40}) {
    INFO("every " << period_ms << " ms");
    std::vector<Arrival> arrivals;
    stray(arrivals, 2, 500, 6000, period_ms);
    live(arrivals, 1, 2000, 6000);
    const Outcome outcome = play(arrivals);
    CHECK(outcome.sweeps[1] >= 38);
    CHECK(outcome.sweeps[2] == 0);
    CHECK(outcome.partial <= 1);  // the sensor's first
  }
}

TEST_CASE(
    "while single packets come from elsewhere, another sensor takes the place of one that fell silent") {
  std::vector<Arrival> arrivals;
  live(arrivals, 1, 1000, 3000);
  stray(arrivals, 2, 1000, 8000, 500);
  live(arrivals, 3, 5000, 8000);
  const Outcome outcome = play(arrivals);
  CHECK(outcome.sweeps[1] == 20);
  CHECK(outcome.sweeps[2] == 0);
  CHECK(outcome.sweeps[3] >= 28);
}

TEST_CASE("of two sensors the first has the port, until it is silent for a second") {
  std::vector<Arrival> arrivals;
  live(arrivals, 1, 1000, 4000);
  live(arrivals, 2, 2000, 8000);
  const Outcome outcome = play(arrivals);
  CHECK(outcome.sweeps[1] == 30);
  CHECK(outcome.sweeps[2] >= 28);
  CHECK(outcome.sweeps[2] <= 31);
  CHECK(outcome.counters.second_sensor_packets >= 30 * kPackets);
}

TEST_CASE("a sensor of which many packets are lost keeps its port against stray ones") {
  std::vector<Arrival> all;
  live(all, 1, 1000, 6000);
  std::vector<Arrival> arrivals;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i % 10 < 5) arrivals.push_back(all[i]);
  stray(arrivals, 2, 1000, 6000, 100);
  const Outcome outcome = play(arrivals, 0.3);
  CHECK(outcome.counters.sweeps >= 45);
  CHECK(outcome.counters.second_sensor_packets >= 49);
  CHECK(outcome.counters.slow_packets == 0);
}

TEST_CASE(
    "a sensor with a sixth of a turn in view is one, where the vehicle's file says that so little will do") {
  std::vector<Arrival> all, arrivals;
  live(all, 1, 1000, 6000);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i % kPackets < 3) arrivals.push_back(all[i]);
  CHECK(play(arrivals, 0.1).counters.sweeps == 0);
  const Outcome outcome = play(arrivals, 0.1, {0.1, 1000});
  CHECK(outcome.counters.sweeps >= 49);
  CHECK(outcome.counters.slow_packets == 0);
}

TEST_CASE("a sender without a sensor's rate gives no sweeps, and is counted") {
  std::vector<Arrival> arrivals;
  stray(arrivals, 2, 1000, 11000, 500);
  const Outcome outcome = play(arrivals);
  CHECK(outcome.counters.sweeps == 0);
  CHECK(outcome.partial == 0);
  CHECK(outcome.counters.dropped_sweeps == 0);
  CHECK(outcome.counters.slow_packets == 17);  // all but those of the second on trial
  CHECK(std::string(ingest::to_text(outcome.counters.slow_address).data()) == "10.0.0.2");
}
