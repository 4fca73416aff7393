// What the messages of a bag say of themselves.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/time_span.hpp"
#include "services/common/bag/bag_reader.hpp"

namespace gvom::ctl {

/// What gvom can make of a topic.
enum class BagTopicUse { none, ouster, velodyne, cloud, odometry, tf, metadata };

struct BagTopicFacts {
  std::string name;
  std::string type;
  BagTopicUse use = BagTopicUse::none;
  std::uint64_t messages = 0;  ///< That could be read.
  std::uint64_t bytes = 0;
  TimeSpan log{0, 0};  ///< When the recorder got the first and the last one.

  /// The messages' own times: what gvom goes by. Of packets the sensor's; of a Velodyne's, which count within
  /// the hour, in the hour of their stamps.
  std::uint64_t stamped = 0;
  TimeSpan stamps{0, 0};           ///< The earliest and the latest.
  std::int64_t least_late_ns = 0;  ///< The recorder's time - the message's own.
  std::int64_t most_late_ns = 0;
  std::uint64_t steps_back =
      0;  ///< How often the own time was more than a second before that of the message before.

  std::string frame_id;
  std::string child_frame_id;                        ///< Of odometry.
  std::set<std::pair<std::string, std::string>> tf;  ///< Parents and children, of tf.
  std::optional<std::uint8_t> velodyne_model_byte;
  std::vector<std::string> fields;  ///< Of clouds.
  std::string metadata;             ///< Of an Ouster, the newest.
};

struct BagFacts {
  std::string path;
  std::vector<BagTopicFacts> topics;  ///< In order of their names.
  TimeSpan log{0, 0};
  std::vector<std::string> warnings;
};

/// Reads all of the bag. Errors are BagReader's.
tl::expected<BagFacts, std::string> read_bag_facts(const std::string& path);

}  // namespace gvom::ctl
