// A sensor_msgs/msg/PointCloud2 as a sweep, whether a bag or the network brings it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/sweep.hpp"
#include "services/common/ros/incoming.hpp"
#include "services/common/source_uri.hpp"
#include "services/ingest/packet.hpp"
#include "services/ingest/pcd.hpp"
#include "services/ingest/point_times.hpp"

namespace gvom::ingest {

/// The options of a URI that CloudSweep takes.
struct CloudOptions {
  std::size_t max_returns = 0;
  std::optional<TimeUnit> time;  ///< Of the time field; `none`: without deskewing. Else it is found out.
};

/// Reads `time=ns`, `us`, `ms`, `s` or `none`, and `deskew=off`, which says the same as `none`.
tl::expected<CloudOptions, std::string> cloud_options(const services::SourceUri& uri,
                                                      std::size_t max_returns);

/// Fields are taken by name, datatype and offset: x, y, z, and the first of t, time, timestamp, time_stamp,
/// time_offset, offset_time. Times follow PointTimes: from the header's stamp, or a clock's. Of one sensor's
/// clouds in a row.
class CloudSweep {
 public:
  /// `topic`: what the clouds are called in warnings. `uri`: the source's scheme, for advice in errors.
  CloudSweep(const CloudOptions& options, std::string topic, const std::string& scheme);

  /// Fills `out` (cleared first). Points of 0, 0, 0 or NaN are in it, and no hits. Counts `overflow_returns`.
  /// Errors: steps, fields or data that don't fit together, no x, y, z, no times, times that can't be.
  tl::expected<void, std::string> make(const ros::PointCloud2In& cloud, SourceState& state, Sweep& out);

 private:
  tl::expected<void, std::string> view(const ros::PointCloud2In& cloud);
  tl::expected<void, std::string> add_field(const ros::PointCloud2In& cloud, const ros::PointFieldIn& field);
  void copy_points(const ros::PointCloud2In& cloud);
  std::size_t limit(SourceState& state);

  CloudOptions options_;
  std::string topic_;
  std::string time_option_;
  PointTimes times_;
  PcdCloud points_;
  std::vector<std::uint8_t> ordered_;  // little-endian, without gaps between rows
  std::vector<bool> is_hit_;
  std::vector<std::int64_t> point_times_ns_;
};

}  // namespace gvom::ingest
