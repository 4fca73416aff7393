// Sweeps out of the clouds that a driver publishes now.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/dds/reader.hpp"
#include "services/common/dds/topic_owner.hpp"
#include "services/ingest/cloud_sweep.hpp"
#include "services/ingest/packet.hpp"
#include "services/ingest/source.hpp"
#include "services/ingest/unused_messages.hpp"

namespace gvom::ingest {

class Ros2Clouds final : public Source {
 public:
  /// `reader` takes the messages of one topic, PointCloud2. `name`: the topic, for warnings.
  Ros2Clouds(dds::Reader reader, const std::string& name, const CloudOptions& options,
             std::int64_t clock_offset_ns);

  /// Clouds that can't be sweeps (no times, no x, y, z, steps that don't fit) are counted as
  /// `foreign_packets`, those of a second publisher as `second_sensor_packets`; the first of the former is
  /// told. Clouds that were lost on the way or not taken in time count as `kernel_drops`. An error when the
  /// network that was joined is gone.
  tl::expected<SourceEvent, std::string> next(Sweep& out, std::chrono::milliseconds timeout) override;
  tl::expected<void, std::string> rewind() override;
  [[nodiscard]] bool is_live() const override { return true; }
  [[nodiscard]] double most_packets_per_s() const override;
  void set_time_hint(std::int64_t /*stamp_ns*/) override {}
  [[nodiscard]] const SourceCounters& counters() const override { return state_.counters; }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return state_.warnings; }

 private:
  bool make(const dds::Message& message, Sweep& out);

  dds::Reader reader_;
  std::string name_;
  CloudSweep sweeps_;
  std::int64_t clock_offset_ns_;
  dds::TopicOwner owner_;
  SourceState state_;
  ros::PointCloud2In cloud_;
  UnusedMessages unused_;
};

}  // namespace gvom::ingest
