#include "services/ingest/bag_packets.hpp"

#include <utility>

namespace gvom::ingest {
BagPackets::BagPackets(bag::BagReader bag, PacketMessages messages, std::string name, SourceState& state)
    : bag_(std::move(bag)), messages_(messages), name_(std::move(name)), state_(state) {}

tl::expected<PacketEvent, std::string> BagPackets::next(Packet& out, std::chrono::milliseconds) {
  while (next_ == packets_.size()) {
    bag::Message message;
    const bool more = bag_.next(message);
    note_warnings();
    if (!more) return PacketEvent::end;
    next_ = 0;
    packets_.clear();
    read_message(message);
  }
  out = packets_[next_++];
  return PacketEvent::packet;
}

void BagPackets::read_message(const bag::Message& message) {
  const auto read = unpack(messages_, message.data, message.log_ns, scan_, packets_);
  if (!read)
    unused_.add(state_, name_ + ": message " + std::to_string(message.number), read.error(),
                message.data.size);
}

void BagPackets::note_warnings() {
  while (warnings_told_ < bag_.warnings().size())
    state_.warnings.push_back(bag_.warnings()[warnings_told_++]);
}

tl::expected<void, std::string> BagPackets::rewind() {
  bag_.rewind();
  packets_.clear();
  next_ = 0;
  return {};
}

}  // namespace gvom::ingest
