#include "services/ingest/bag_packets.hpp"

#include <utility>

namespace gvom::ingest {
namespace {

/// What a Packet can say: from 1970 to 2106, else 0, not known.
std::int64_t capture_time_ns(std::int64_t time_ns) {
  const bool sane = time_ns >= 0 && time_ns < std::int64_t{0x100000000} * 1'000'000'000;
  return sane ? time_ns : 0;
}

}  // namespace

BagPackets::BagPackets(bag::BagReader bag, Messages messages, std::string name, SourceState& state)
    : bag_(std::move(bag)), messages_(messages), name_(std::move(name)), state_(state) {}

tl::expected<PacketEvent, std::string> BagPackets::next(Packet& out, std::chrono::milliseconds) {
  while (next_ == packets_.size()) {
    bag::Message message;
    const bool more = bag_.next(message);
    note_warnings();
    if (!more) return PacketEvent::end;
    next_ = 0;
    packets_.clear();
    if (read_message(message)) continue;
    ++state_.counters.foreign_packets;
  }
  out = packets_[next_++];
  return PacketEvent::packet;
}

bool BagPackets::read_message(const bag::Message& message) {
  tl::expected<void, std::string> read;
  Packet packet;
  if (messages_ == Messages::ouster) {
    ros::Bytes bytes;
    read = ros::read_ouster_packet(message.data, bytes);
    packet.data = bytes.data;
    packet.size = bytes.size;
    packet.capture_ns = capture_time_ns(message.log_ns);
    if (read) packets_.push_back(packet);
  } else {
    ros::HeaderIn header;
    read = ros::read_velodyne_scan(message.data, header, scan_);
    for (const ros::VelodynePacketIn& in : scan_) {
      if (!read) break;
      packet.data = in.data;
      packet.size = ros::kVelodynePacketBytes;
      packet.capture_ns = capture_time_ns(in.stamp_ns);
      packets_.push_back(packet);
    }
  }
  if (!read && !std::exchange(told_foreign_, true))
    state_.warnings.push_back(name_ + ": message " + std::to_string(message.number) + ": " + read.error() +
                              ": it is not used, and neither are others like it");
  return read.has_value();
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
