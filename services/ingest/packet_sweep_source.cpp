#include "services/ingest/packet_sweep_source.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "ipc/clock.hpp"

namespace gvom::ingest {
namespace {

constexpr int kUnrecognisedBeforeWarning = 500;
// A live queue is drained even when the timeout is over, but a flood of foreign packets must not hold the
// caller.
constexpr std::int64_t kMaxOvertimeNs = 50'000'000;
constexpr std::int64_t kSilenceNs = 1'000'000'000;
constexpr std::int64_t kWallStep_ns = 10'000'000;
constexpr int kWallPackets = 8;  // one may differ that waited while the clock was set

std::string why_no_sweep(const SourceCounters& c) {
  const std::pair<std::uint64_t, const char*> reasons[] = {
      {c.dropped_sweeps, "sweeps of less than min_sweep_fraction of their columns"},
      {c.misfit_sweeps, "sweeps of another mode or pace than the source says"},
      {c.withheld_sweeps, "sweeps of a sender that is on trial"},
      {c.foreign_packets, "packets that are not of such a sensor"},
      {c.second_sensor_packets, "packets of another such sensor"},
      {c.slow_packets, "packets of a sender that is too slow"},
      {c.truncated_packets, "packets captured shorter than sent"},
      {c.late_packets, "packets of a sweep that is closed"},
      {c.duplicate_packets, "packets that came again"},
      {c.lost_fragments, "datagrams of which a fragment is missing"},
      {c.invalid_columns, "columns that the sensor marks invalid, or that cannot be"},
  };
  std::string text = "no sweep came of " + std::to_string(c.packets) + " packets";
  const char* between = ": ";
  for (const auto& [count, what] : reasons) {
    if (count == 0) continue;
    text += between + std::to_string(count) + " " + what;
    between = ", ";
  }
  return text;
}

/// A sensor whose sweeps may be small, as its field of view is, sends as much less.
double least_packets_per_s(const Decoder& decoder, const SourceOptions& options) {
  return decoder.least_packets_per_s() * std::clamp(2 * options.min_sweep_fraction, 0.1, 1.0);
}

}  // namespace

PacketSweepSource::PacketSweepSource(std::unique_ptr<SourceState> state,
                                     std::unique_ptr<PacketSource> packets, std::unique_ptr<Decoder> decoder,
                                     const SourceOptions& options, std::optional<Address> only_from)
    : state_(std::move(state)),
      packets_(std::move(packets)),
      decoder_(std::move(decoder)),
      clock_offset_ns_(options.clock_offset_ns),
      only_from_(only_from),
      owner_(least_packets_per_s(*decoder_, options), decoder_->most_packets_per_s()) {
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
  anything_fits_ = true;
  if (!decoder_->is_of_this_sensor(packet) || (only_from_ && *only_from_ != packet.source)) {
    count_second(packet);
    return false;
  }
  return is_live() ? decode_live(packet, out) : decode_recorded(packet, out);
}

bool PacketSweepSource::decode_live(const Packet& packet, Sweep& out) {
  const bool was_proven = owner_.is_proven();
  switch (owner_.judge({packet.source, decoder_->sensor_id(packet)}, packet.received_ns)) {
    case PortOwner::Verdict::use:
      return use(packet, out) && (owner_.is_proven() || withhold(out));
    case PortOwner::Verdict::slow:
      ++state_->counters.slow_packets;
      state_->counters.slow_address = packet.source;
      return false;
    case PortOwner::Verdict::other:
      break;
    case PortOwner::Verdict::new_owner:
      count_second(packet);
      return change_sensor(out) && (was_proven || withhold(out));
  }
  count_second(packet);
  return false;
}

/// The first sender is the sensor. Another one is once it has sent many packets running and the sensor none
/// for a second: it got another address, or another recording begins here.
bool PacketSweepSource::decode_recorded(const Packet& packet, Sweep& out) {
  if (!sensor_) sensor_ = packet.source;
  if (*sensor_ == packet.source) {
    heard_ns_ = packet.capture_ns;
    other_sensor_.fits();
    return use(packet, out);
  }
  count_second(packet);
  warn_of_second(packet);
  if (!takes_over(packet)) return false;
  sensor_ = packet.source;
  return change_sensor(out);
}

bool PacketSweepSource::takes_over(const Packet& packet) {
  const bool many = other_sensor_.misfits();
  const std::int64_t silent_ns = packet.capture_ns - heard_ns_;
  return many && (packet.capture_ns == 0 || silent_ns < 0 || silent_ns > kSilenceNs);
}

bool PacketSweepSource::change_sensor(Sweep& out) {
  const bool closed = decoder_->finish(out);
  decoder_->reset();
  clock_is_new_ = true;
  return closed;
}

/// A sweep of a sender that has not had a sensor's rate is none.
bool PacketSweepSource::withhold(Sweep& out) {
  SourceCounters& counters = state_->counters;
  --counters.sweeps;
  if (!out.complete) --counters.incomplete_sweeps;
  ++counters.withheld_sweeps;
  out.clear();
  return false;
}

/// Live, arrivals are the wall clock's. Where that was set, the line through them begins anew: it would take
/// a small step for a delay.
bool PacketSweepSource::wall_was_set(const Packet& packet) {
  if (packet.received_ns == 0) return false;
  const std::int64_t ahead_ns = packet.capture_ns - packet.received_ns;
  const bool differs = wall_ahead_ns_ && std::llabs(ahead_ns - *wall_ahead_ns_) > kWallStep_ns;
  wall_differs_ = differs ? wall_differs_ + 1 : 0;
  if (differs && wall_differs_ < kWallPackets) return false;
  wall_ahead_ns_ = ahead_ns;
  wall_differs_ = 0;
  return differs;
}

bool PacketSweepSource::use(const Packet& packet, Sweep& out) {
  if (arrival_ && (wall_was_set(packet) || clock_is_new_)) arrival_.emplace();
  clock_is_new_ = false;
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
  counters.second_address = packet.source;
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

/// Once, of a recording; live, Health tells it.
void PacketSweepSource::warn_of_second(const Packet& packet) {
  if (warned_of_second_) return;
  warned_of_second_ = true;
  state_->warnings.push_back(std::string("packets of such a sensor come from ") + to_text(*sensor_).data() +
                             " and from " + to_text(packet.source).data() +
                             ": only the first one's are used; from=ADDRESS takes the other's");
}

void PacketSweepSource::warn_if_nothing_fits(std::size_t packet_size) {
  if (anything_fits_ || ++unrecognised_ != kUnrecognisedBeforeWarning) return;
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
  if (!ended_ && state_->counters.sweeps == 0) state_->warnings.push_back(why_no_sweep(state_->counters));
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
  other_sensor_.fits();
  error_.reset();
  ended_ = false;
  return {};
}

}  // namespace gvom::ingest
