#include "tools/ctl/bag_facts.hpp"

#include <algorithm>
#include <cstring>
#include <map>

#include "services/common/ros/incoming.hpp"

namespace gvom::ctl {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kHour_ns = 3600 * kSecond_ns;
constexpr std::size_t kMostLinks = 100;

bool begins_with(const std::string& text, const std::string& begin) {
  return text.compare(0, begin.size(), begin) == 0;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

BagTopicUse use_of(const bag::Topic& topic) {
  const std::string& type = topic.type;
  if (topic.encoding != "cdr") return BagTopicUse::none;
  if (begins_with(type, "ouster") && ends_with(type, "/PacketMsg")) return BagTopicUse::ouster;
  if (type == "velodyne_msgs/msg/VelodyneScan") return BagTopicUse::velodyne;
  if (type == "sensor_msgs/msg/PointCloud2") return BagTopicUse::cloud;
  if (type == "nav_msgs/msg/Odometry") return BagTopicUse::odometry;
  if (type == "tf2_msgs/msg/TFMessage") return BagTopicUse::tf;
  if (type == "std_msgs/msg/String" && ends_with(topic.name, "metadata")) return BagTopicUse::metadata;
  return BagTopicUse::none;
}

/// Types that begin with a std_msgs/msg/Header.
bool has_header(const std::string& type) {
  return begins_with(type, "sensor_msgs/msg/") || begins_with(type, "nav_msgs/msg/") ||
         (begins_with(type, "geometry_msgs/msg/") && ends_with(type, "Stamped"));
}

/// Of the packet's first column: behind the header that all profiles but LEGACY have.
std::optional<std::int64_t> ouster_time_ns(ros::Bytes packet) {
  constexpr std::size_t kLegacyColumns = 16;
  constexpr std::size_t kLegacyColumnBytes = 20;  // without pixels
  constexpr std::size_t kLegacyPixelBytes = 12;
  constexpr std::size_t kHeaderBytes = 32;
  bool legacy = false;
  for (const std::size_t beams : {16, 32, 64, 128})
    legacy = legacy || packet.size == kLegacyColumns * (kLegacyColumnBytes + beams * kLegacyPixelBytes);
  const std::size_t at = legacy ? 0 : kHeaderBytes;
  std::int64_t time_ns = 0;
  if (packet.size < 256 || packet.size < at + sizeof time_ns) return std::nullopt;  // IMU packets are small
  std::memcpy(&time_ns, packet.data + at, sizeof time_ns);
  if (time_ns < 0) return std::nullopt;
  return time_ns;
}

/// Microseconds past the hour, in the hour that brings them nearest to the packet's stamp.
std::int64_t velodyne_time_ns(const ros::VelodynePacketIn& packet) {
  std::uint32_t time_us = 0;
  std::memcpy(&time_us, packet.data + ros::kVelodynePacketBytes - 6, sizeof time_us);
  const std::int64_t in_hour_ns = std::int64_t{time_us} * 1000;
  std::int64_t difference_ns = (in_hour_ns - packet.stamp_ns) % kHour_ns;
  if (difference_ns > kHour_ns / 2) difference_ns -= kHour_ns;
  if (difference_ns < -kHour_ns / 2) difference_ns += kHour_ns;
  return packet.stamp_ns + difference_ns;
}

/// Looks at the messages of one topic after another.
class Look {
 public:
  explicit Look(BagTopicFacts& facts) : facts_(facts) {}

  void see(const bag::Message& message) {
    facts_.log.first_ns =
        facts_.messages == 0 ? message.log_ns : std::min(facts_.log.first_ns, message.log_ns);
    facts_.log.last_ns = facts_.messages == 0 ? message.log_ns : std::max(facts_.log.last_ns, message.log_ns);
    ++facts_.messages;
    facts_.bytes += message.data.size;
    if (const auto stamp_ns = stamp_of(message.data)) note(*stamp_ns, message.log_ns);
  }

 private:
  std::optional<std::int64_t> stamp_of(ros::Bytes data) {
    switch (facts_.use) {
      case BagTopicUse::ouster:
        return ouster(data);
      case BagTopicUse::velodyne:
        return velodyne(data);
      case BagTopicUse::cloud:
        return cloud(data);
      case BagTopicUse::odometry:
        return odometry(data);
      case BagTopicUse::tf:
        return tf(data);
      case BagTopicUse::metadata:
        return metadata(data);
      case BagTopicUse::none:
        break;
    }
    ros::HeaderIn header;
    if (!has_header(facts_.type) || !ros::read_header(data, header)) return std::nullopt;
    facts_.frame_id = header.frame_id;
    return header.stamp_ns;
  }

  static std::optional<std::int64_t> ouster(ros::Bytes data) {
    ros::Bytes packet;
    if (!ros::read_ouster_packet(data, packet)) return std::nullopt;
    return ouster_time_ns(packet);
  }

  std::optional<std::int64_t> velodyne(ros::Bytes data) {
    ros::HeaderIn header;
    if (!ros::read_velodyne_scan(data, header, packets_) || packets_.empty()) return std::nullopt;
    facts_.frame_id = header.frame_id;
    facts_.velodyne_model_byte = packets_.back().data[ros::kVelodynePacketBytes - 1];
    return velodyne_time_ns(packets_.back());
  }

  std::optional<std::int64_t> cloud(ros::Bytes data) {
    if (!ros::read_point_cloud(data, cloud_)) return std::nullopt;
    facts_.frame_id = cloud_.header.frame_id;
    facts_.fields.clear();
    for (const ros::PointFieldIn& field : cloud_.fields) facts_.fields.emplace_back(field.name);
    return cloud_.header.stamp_ns;
  }

  std::optional<std::int64_t> odometry(ros::Bytes data) {
    ros::OdometryIn odometry;
    if (!ros::read_odometry(data, odometry)) return std::nullopt;
    facts_.frame_id = odometry.header.frame_id;
    facts_.child_frame_id = odometry.child_frame_id;
    return odometry.header.stamp_ns;
  }

  std::optional<std::int64_t> tf(ros::Bytes data) {
    if (!ros::read_transforms(data, transforms_) || transforms_.empty()) return std::nullopt;
    std::int64_t newest_ns = transforms_.front().header.stamp_ns;
    for (const ros::TransformIn& transform : transforms_) {
      newest_ns = std::max(newest_ns, transform.header.stamp_ns);
      if (facts_.tf.size() < kMostLinks)
        facts_.tf.emplace(transform.header.frame_id, transform.child_frame_id);
    }
    return newest_ns;
  }

  std::optional<std::int64_t> metadata(ros::Bytes data) {
    constexpr std::size_t kMostBytes = 1 << 20;
    ros::CdrReader cdr(data);
    facts_.metadata = cdr.string(kMostBytes);
    return std::nullopt;
  }

  void note(std::int64_t stamp_ns, std::int64_t log_ns) {
    const std::int64_t late_ns = log_ns - stamp_ns;
    const bool first = facts_.stamped++ == 0;
    facts_.stamps.first_ns = first ? stamp_ns : std::min(facts_.stamps.first_ns, stamp_ns);
    facts_.stamps.last_ns = first ? stamp_ns : std::max(facts_.stamps.last_ns, stamp_ns);
    facts_.least_late_ns = first ? late_ns : std::min(facts_.least_late_ns, late_ns);
    facts_.most_late_ns = first ? late_ns : std::max(facts_.most_late_ns, late_ns);
    if (!first && stamp_ns < before_ns_ - kSecond_ns) ++facts_.steps_back;
    before_ns_ = stamp_ns;
  }

  BagTopicFacts& facts_;
  std::int64_t before_ns_ = 0;
  std::vector<ros::VelodynePacketIn> packets_;
  std::vector<ros::TransformIn> transforms_;
  ros::PointCloud2In cloud_;
};

}  // namespace

tl::expected<BagFacts, std::string> read_bag_facts(const std::string& path) {
  auto reader = bag::BagReader::open(path, {});
  if (!reader) return tl::unexpected(reader.error());
  BagFacts facts;
  facts.path = path;
  facts.log = {reader->first_ns(), reader->last_ns()};
  facts.topics.resize(reader->topics().size());
  std::map<const bag::Topic*, Look> looks;
  for (std::size_t i = 0; i < facts.topics.size(); ++i) {
    const bag::Topic& topic = *reader->topics()[i];
    facts.topics[i].name = topic.name;
    facts.topics[i].type = topic.type;
    facts.topics[i].use = use_of(topic);
    looks.emplace(&topic, Look(facts.topics[i]));
  }
  bag::Message message;
  while (reader->next(message)) looks.at(message.topic).see(message);
  facts.warnings = reader->warnings();
  return facts;
}

}  // namespace gvom::ctl
