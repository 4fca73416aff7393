// Sweeps out of a bag's point clouds.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/bag/bag_reader.hpp"
#include "services/ingest/cloud_sweep.hpp"
#include "services/ingest/packet.hpp"
#include "services/ingest/unused_messages.hpp"

namespace gvom::ingest {

class BagClouds final : public Source {
 public:
  /// `bag` gives the messages of one topic, PointCloud2. `name`: the bag and topic, for warnings. An error if
  /// the first cloud can't be a sweep: no times, no x, y, z, another unit than is asked for.
  static tl::expected<std::unique_ptr<Source>, std::string> open(bag::BagReader bag, const std::string& name,
                                                                 const CloudOptions& options,
                                                                 std::int64_t clock_offset_ns);

  /// Clouds that can't be sweeps are counted as `foreign_packets` and passed over; the first is told, with
  /// its number.
  tl::expected<SourceEvent, std::string> next(Sweep& out, std::chrono::milliseconds timeout) override;
  tl::expected<void, std::string> rewind() override;
  [[nodiscard]] bool is_live() const override { return false; }
  void set_time_hint(std::int64_t /*stamp_ns*/) override {}
  [[nodiscard]] const SourceCounters& counters() const override { return state_.counters; }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return state_.warnings; }

 private:
  BagClouds(bag::BagReader bag, const std::string& name, const CloudOptions& options,
            std::int64_t clock_offset_ns);
  tl::expected<void, std::string> judge_first();
  tl::expected<void, std::string> make(const bag::Message& message, Sweep& out);

  bag::BagReader bag_;
  std::string name_;
  CloudSweep sweeps_;
  std::int64_t clock_offset_ns_;
  SourceState state_;
  ros::PointCloud2In cloud_;
  std::size_t warnings_told_ = 0;
  UnusedMessages unused_;
};

}  // namespace gvom::ingest
