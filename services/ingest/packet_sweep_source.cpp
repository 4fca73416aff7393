#include "services/ingest/packet_sweep_source.hpp"

#include <algorithm>
#include <utility>

#include "ipc/clock.hpp"

namespace gvom::ingest {
namespace {

constexpr int kUnrecognisedBeforeWarning = 500;
// A live queue is drained even when the timeout is over, but a flood of foreign packets must not hold the
// caller.
constexpr std::int64_t kMaxOvertimeNs = 50'000'000;
constexpr std::int64_t kSilenceNs = 1'000'000'000;

}  // namespace

PacketSweepSource::PacketSweepSource(std::unique_ptr<SourceState> state,
                                     std::unique_ptr<PacketSource> packets, std::unique_ptr<Decoder> decoder,
                                     const SourceOptions& options)
    : state_(std::move(state)),
      packets_(std::move(packets)),
      decoder_(std::move(decoder)),
      clock_offset_ns_(options.clock_offset_ns) {
  if (options.by_arrival) arrival_.emplace();
}

tl::expected<SourceEvent, std::string> PacketSweepSource::next(Sweep& out,
                                                               std::chrono::milliseconds timeout) {
  out.clear();
  if (ended_) return end(out);
  const std::int64_t deadline_ns = ipc::monotonic_ns() + std::chrono::nanoseconds(timeout).count();
  std::chrono::milliseconds wait = timeout;
  for (;;) {
    Packet packet;
    const auto event = packets_->next(packet, wait);
    if (!event) error_ = event.error();
    if (!event || *event == PacketEvent::end) return end(out);
    if (*event == PacketEvent::idle) return SourceEvent::kIdle;
    if (decode(packet, out)) return hand_out(out);
    if (!is_live()) continue;
    const std::int64_t left_ns = deadline_ns - ipc::monotonic_ns();
    if (left_ns < -kMaxOvertimeNs) return SourceEvent::kIdle;
    wait = std::chrono::milliseconds(left_ns > 0 ? left_ns / 1'000'000 : 0);
  }
}

bool PacketSweepSource::decode(const Packet& packet, Sweep& out) {
  ++state_->counters.packets;
  if (!decoder_->recognises(packet)) {
    count_foreign(packet);
    warn_if_nothing_fits(packet.size);
    return false;
  }
  const bool of_this_sensor = decoder_->is_of_this_sensor(packet);
  if (of_this_sensor && is_of_our_sensor(packet)) return use(packet, out);
  count_second(packet);
  if (!of_this_sensor) return false;
  // The new sensor's frames must not go into the open sweep of the one before.
  return !sensor_ && decoder_->finish(out);
}

bool PacketSweepSource::use(const Packet& packet, Sweep& out) {
  const bool closed = decoder_->decode(packet, out);
  const auto stamp_ns = decoder_->packet_time_ns();
  if (arrival_ && stamp_ns) arrival_->take(*stamp_ns, packet.capture_ns);
  return closed;
}

SourceEvent PacketSweepSource::hand_out(Sweep& out) const {
  if (arrival_) arrival_->move(out);
  shift(out, clock_offset_ns_);
  return SourceEvent::kSweep;
}

void PacketSweepSource::count_foreign(const Packet& packet) {
  SourceCounters& counters = state_->counters;
  if (decoder_->is_side_packet(packet)) {
    ++counters.foreign_packets;
    ++counters.side_packets;
    return;
  }
  if (++counters.foreign_packets > 1 && counters.foreign_size != packet.size) ++counters.foreign_size_changes;
  counters.foreign_size = packet.size;
  decoder_->name_other(packet, counters.foreign_kind);
  warn_of_other(counters.foreign_kind);
}

void PacketSweepSource::count_second(const Packet& packet) {
  SourceCounters& counters = state_->counters;
  ++counters.second_sensor_packets;
  std::copy_n(packet.source.begin(), counters.second_ipv4.size(), counters.second_ipv4.begin());
  decoder_->name_other(packet, counters.second_kind);
  warn_of_other(counters.second_kind);
}

/// Once: Health tells it as long as such packets come.
void PacketSweepSource::warn_of_other(const KindText& kind) {
  if (kind[0] == '\0' || warned_of_other_) return;
  warned_of_other_ = true;
  state_->warnings.push_back("packets of another sensor (" + std::string(kind.data()) +
                             ") come too: none of them is used; expected: " + decoder_->expects());
}

/// The first sender is the sensor until another one takes over.
bool PacketSweepSource::is_of_our_sensor(const Packet& packet) {
  const Sender sender{packet.source, is_live() ? decoder_->sensor_id(packet) : 0};
  if (!sensor_ || (!is_live() && takes_over(packet, sender))) sensor_ = sender;
  if (*sensor_ == sender) {
    heard_ns_ = packet.received_ns;
    other_sensor_.fits();
    return true;
  }
  if (is_live() && takes_over(packet, sender)) sensor_.reset();  // the next packet says who it is
  other_ = sender;
  return false;
}

/// Live, another sender is the sensor now if it sent two packets running and the one before has been silent
/// for a second: it was exchanged, or given a new address. In a recording, if it sent many running.
bool PacketSweepSource::takes_over(const Packet& packet, const Sender& sender) {
  if (!is_live()) return !(*sensor_ == sender) && other_sensor_.misfits();
  return other_ && *other_ == sender && packet.received_ns - heard_ns_ > kSilenceNs;
}

void PacketSweepSource::warn_if_nothing_fits(std::size_t packet_size) {
  if (sensor_ || ++unrecognised_ != kUnrecognisedBeforeWarning) return;
  state_->warnings.push_back("none of " + std::to_string(unrecognised_) + " packets is what is expected (" +
                             decoder_->expects() + "); the last one has " + std::to_string(packet_size) +
                             " bytes");
}

/// The open sweep first, then the error if there is one, then the end.
tl::expected<SourceEvent, std::string> PacketSweepSource::end(Sweep& out) {
  if (!ended_ && decoder_->finish(out)) {
    ended_ = true;
    return hand_out(out);
  }
  ended_ = true;
  if (!error_) return SourceEvent::kEnd;
  const std::string error = std::move(*error_);
  error_.reset();
  return tl::unexpected(error);
}

tl::expected<void, std::string> PacketSweepSource::rewind() {
  auto done = packets_->rewind();
  if (!done) return done;
  decoder_->reset();
  if (arrival_) arrival_.emplace();
  sensor_.reset();
  other_.reset();
  other_sensor_.fits();
  error_.reset();
  ended_ = false;
  return {};
}

}  // namespace gvom::ingest
