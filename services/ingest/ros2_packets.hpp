// A sensor's packets as its driver publishes them now.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/dds/reader.hpp"
#include "services/ingest/packet_messages.hpp"
#include "services/ingest/unused_messages.hpp"

namespace gvom::ingest {

/// A packet's sender is its publisher. Packets of one scan were received as far apart as their stamps say,
/// the last of them when the scan was.
class Ros2Packets final : public PacketSource {
 public:
  /// `reader` takes the messages of one topic, of that kind. `name`: the topic, for warnings. `state`
  /// outlives it.
  Ros2Packets(dds::Reader reader, PacketMessages kind, std::string name, SourceState& state);

  /// Messages that are not what their type says are counted as `foreign_packets` and passed over; the first
  /// is told. Messages that were lost on the way or not taken in time count as `kernel_drops`. An error when
  /// the network that was joined is gone.
  tl::expected<PacketEvent, std::string> next(Packet& out, std::chrono::milliseconds timeout) override;
  tl::expected<void, std::string> rewind() override;
  [[nodiscard]] bool is_live() const override { return true; }

 private:
  void read_message();
  void set_received();

  dds::Reader reader_;
  PacketMessages kind_;
  std::string name_;
  SourceState& state_;
  std::optional<dds::Message> message_;  // that the packets point into
  std::vector<ros::VelodynePacketIn> scan_;
  std::vector<Packet> packets_;
  std::size_t next_ = 0;
  UnusedMessages unused_;
};

}  // namespace gvom::ingest
