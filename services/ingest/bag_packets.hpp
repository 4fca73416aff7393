// A sensor's packets out of a bag: Ouster's PacketMsg, Velodyne's VelodyneScan.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/bag/bag_reader.hpp"
#include "services/common/ros/incoming.hpp"
#include "services/ingest/packet.hpp"
#include "services/ingest/packet_messages.hpp"
#include "services/ingest/unused_messages.hpp"

namespace gvom::ingest {

/// A packet's capture time is its own stamp in a scan, else the recorder's: each the nearest to the moment at
/// which it came.
class BagPackets final : public PacketSource {
 public:
  /// `bag` gives the messages of one topic. `name`: the bag and topic, for warnings. `state` outlives it.
  BagPackets(bag::BagReader bag, PacketMessages messages, std::string name, SourceState& state);

  /// Messages that are not what their type says are counted as `foreign_packets` and passed over; the first
  /// is told, with its number.
  tl::expected<PacketEvent, std::string> next(Packet& out, std::chrono::milliseconds timeout) override;
  tl::expected<void, std::string> rewind() override;
  [[nodiscard]] bool is_live() const override { return false; }

 private:
  void read_message(const bag::Message& message);
  void note_warnings();

  bag::BagReader bag_;
  PacketMessages messages_;
  std::string name_;
  SourceState& state_;
  std::vector<ros::VelodynePacketIn> scan_;
  std::vector<Packet> packets_;  // of the newest message
  std::size_t next_ = 0;
  std::size_t warnings_told_ = 0;
  UnusedMessages unused_;
};

}  // namespace gvom::ingest
