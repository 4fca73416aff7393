#include "tools/play/player.hpp"

#include <algorithm>

namespace gvom::play {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::nanoseconds;

/// The pace: when a payload is due. A new pass begins one mean gap after the last payload of the one before.
class Pace {
 public:
  explicit Pace(double rate) : rate_(rate), start_(Clock::now()) {}

  Clock::time_point due(std::int64_t capture_ns) {
    if (count_++ == 0) first_ns_ = capture_ns;
    last_ns_ = std::max(last_ns_, capture_ns);
    return start_ + scaled(capture_ns - first_ns_);
  }

  void begin_pass() {
    const std::int64_t span_ns = last_ns_ - first_ns_;
    start_ += scaled(span_ns + (count_ > 1 ? span_ns / (count_ - 1) : 0));
    count_ = 0;
    last_ns_ = 0;
  }

 private:
  [[nodiscard]] nanoseconds scaled(std::int64_t recorded_ns) const {
    return nanoseconds(static_cast<std::int64_t>(static_cast<double>(recorded_ns) / rate_));
  }

  double rate_;
  Clock::time_point start_;
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
  std::int64_t count_ = 0;
};

/// Nothing: this payload is not played.
std::optional<std::uint16_t> port_for(std::uint16_t recorded, const PlayOptions& options) {
  if (options.port) return options.port;
  if (options.mapped_ports.empty()) return recorded;
  const auto found = options.mapped_ports.find(recorded);
  if (found == options.mapped_ports.end()) return std::nullopt;
  return found->second;
}

void send_now(const ingest::Packet& packet, std::uint16_t port, Clock::time_point due, UdpSender& sender,
              PlaySummary& summary) {
  const nanoseconds delay = Clock::now() - due;
  if (!sender.send(packet.data, packet.size, port)) {
    ++summary.failed;
    return;
  }
  ++summary.packets;
  summary.bytes += packet.size;
  if (delay > kLate) ++summary.late;
  summary.worst_delay = std::max(summary.worst_delay, delay);
}

}  // namespace

tl::expected<PlaySummary, std::string> play(ingest::PacketSource& recording, UdpSender& sender,
                                            const PlayOptions& options, const SleepUntil& sleep_until) {
  PlaySummary summary;
  Pace pace(options.rate);
  ingest::Packet packet;
  while (true) {
    const auto event = recording.next(packet, std::chrono::milliseconds{0});
    if (!event) return tl::make_unexpected(event.error());
    if (*event == ingest::PacketEvent::end) {
      ++summary.passes;
      if (!options.loop || summary.packets == 0) return summary;
      if (auto again = recording.rewind(); !again) return tl::make_unexpected(again.error());
      pace.begin_pass();
      continue;
    }
    const auto port = port_for(packet.port, options);
    if (!port) {
      ++summary.left_out;
      continue;
    }
    const auto due = pace.due(packet.capture_ns);
    if (!sleep_until(due)) return summary;
    send_now(packet, *port, due, sender, summary);
  }
}

}  // namespace gvom::play
