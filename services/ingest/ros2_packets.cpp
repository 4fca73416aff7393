#include "services/ingest/ros2_packets.hpp"

#include <algorithm>
#include <utility>

#include "ipc/clock.hpp"
#include "services/ingest/ros2_publisher.hpp"

namespace gvom::ingest {

Ros2Packets::Ros2Packets(dds::Reader reader, PacketMessages kind, std::string name, SourceState& state)
    : reader_(std::move(reader)), kind_(kind), name_(std::move(name)), state_(state) {}

tl::expected<PacketEvent, std::string> Ros2Packets::next(Packet& out, std::chrono::milliseconds timeout) {
  if (next_ == packets_.size()) {
    message_ = reader_.take(timeout);
    const dds::ReaderCounters reader = reader_.counters();
    state_.counters.kernel_drops = reader.lost + reader.replaced;
    if (message_) read_message();
    if (const std::string loss = message_ ? "" : reader_.network_loss(); !loss.empty())
      return tl::unexpected(name_ + ": " + loss);
  }
  if (next_ == packets_.size()) return PacketEvent::idle;
  out = packets_[next_++];
  return PacketEvent::packet;
}

void Ros2Packets::read_message() {
  next_ = 0;
  const std::int64_t waited_ns = ipc::monotonic_ns() - message_->arrived_ns;
  const std::int64_t came_ns = ipc::clock_ns(CLOCK_REALTIME) - waited_ns;
  const auto read = unpack(kind_, {message_->cdr->data(), message_->cdr->size()}, came_ns, scan_, packets_);
  if (read) return set_received();
  ++state_.counters.packets;
  unused_.add(state_, name_, read.error(), message_->cdr->size());
}

void Ros2Packets::set_received() {
  constexpr std::int64_t kLongestScan_ns = 1'000'000'000;
  const std::int64_t suspended_ns = ipc::suspended_ns();
  const Address sender = address_of_publisher(message_->publisher);
  for (Packet& packet : packets_) {
    const std::int64_t before_last_ns = packets_.back().capture_ns - packet.capture_ns;
    packet.received_ns = message_->arrived_ns - std::clamp<std::int64_t>(before_last_ns, 0, kLongestScan_ns);
    packet.suspended_ns = suspended_ns;
    packet.source = sender;
  }
}

tl::expected<void, std::string> Ros2Packets::rewind() {
  return tl::unexpected(name_ + ": a live source cannot start again");
}

}  // namespace gvom::ingest
