#include "services/ingest/bag_source.hpp"

#include <string>
#include <utility>

#include "services/common/bag/bag_reader.hpp"
#include "services/ingest/bag_clouds.hpp"
#include "services/ingest/bag_packets.hpp"
#include "services/ingest/make_decoder.hpp"
#include "services/ingest/packet_sweep_source.hpp"
#include "services/ingest/probe.hpp"

namespace gvom::ingest {
namespace {

using SourceResult = tl::expected<std::unique_ptr<Source>, SourceError>;

enum class Kind { ouster, velodyne, cloud };

const std::string kOusterPacket = "/PacketMsg";  // of ouster_sensor_msgs, ouster_msgs or ouster_ros
const std::string kVelodyneScan = "velodyne_msgs/msg/VelodyneScan";
const std::string kCloud = "sensor_msgs/msg/PointCloud2";

tl::expected<Kind, std::string> kind_of(const bag::Topic& topic, const std::string& name) {
  if (topic.encoding != "cdr")
    return tl::unexpected(name + ": its messages are '" + topic.encoding +
                          "', not CDR: a bag of ROS 2 is needed");
  const std::string& type = topic.type;
  if (type == kCloud) return Kind::cloud;
  if (type == kVelodyneScan) return Kind::velodyne;
  const bool is_packet =
      type.size() > kOusterPacket.size() &&
      type.compare(type.size() - kOusterPacket.size(), std::string::npos, kOusterPacket) == 0;
  if (is_packet && type.compare(0, 6, "ouster") == 0) return Kind::ouster;
  return tl::unexpected(name + ": is of type " + type + ", which is not read (sensor_msgs/msg/PointCloud2, " +
                        "velodyne_msgs/msg/VelodyneScan, ouster_sensor_msgs/msg/PacketMsg are)");
}

struct OpenTopic {
  bag::BagReader reader;
  std::string name;  // the bag and the topic, for messages
  Kind kind;
};

tl::expected<OpenTopic, std::string> open_topic(const services::SourceUri& uri) {
  const auto topic = uri.option("topic");
  if (!topic)
    return tl::unexpected("source '" + uri.text + "': needs topic=TOPIC (gvomctl bag " + uri.path +
                          " lists them)");
  auto reader = bag::BagReader::open(uri.path, {*topic});
  if (!reader) return tl::unexpected(reader.error());
  const std::string name = uri.path + " " + *topic;
  const auto found = reader->find(*topic);
  if (found.size() > 1)
    return tl::unexpected(name + ": is of two types, " + found[0]->type + " and " + found[1]->type);
  const auto kind = kind_of(*found[0], name);
  if (!kind) return tl::unexpected(kind.error());
  return OpenTopic{std::move(*reader), name, *kind};
}

PacketMessages messages_of(Kind kind) {
  return kind == Kind::ouster ? PacketMessages::ouster : PacketMessages::velodyne;
}

std::set<std::string> options_of(Kind kind) {
  std::set<std::string> allowed{"topic"};
  if (kind == Kind::ouster) allowed.insert(kOusterOptions.begin(), kOusterOptions.end());
  if (kind == Kind::velodyne) allowed.insert(kVelodyneOptions.begin(), kVelodyneOptions.end());
  if (kind == Kind::cloud) allowed.insert({"deskew", "time"});
  return allowed;
}

SourceResult open_clouds(const services::SourceUri& uri, const SourceOptions& options,
                         const std::string& name, bag::BagReader reader) {
  if (options.by_arrival)
    return tl::unexpected("source '" + uri.text +
                          "': clock: arrival needs packets; clouds have no times of arrival");
  const auto clouds = cloud_options(uri, options.max_returns);
  if (!clouds) return tl::unexpected(clouds.error());
  return BagClouds::open(std::move(reader), name, *clouds, options.clock_offset_ns);
}

SourceResult open_packets(const services::SourceUri& uri, const SourceOptions& options,
                          const std::string& name, bag::BagReader reader, Kind kind) {
  const bool ouster = kind == Kind::ouster;
  auto state = std::make_unique<SourceState>();
  auto decoder =
      ouster ? make_ouster_decoder(uri, options, *state) : make_velodyne_decoder(uri, options, *state);
  if (!decoder) return tl::unexpected(decoder.error());
  auto packets = std::make_unique<BagPackets>(std::move(reader), messages_of(kind), name, *state);
  const auto strangers = look_for_sensor(*packets, **decoder);
  if (!strangers) return tl::unexpected(strangers.error());
  if (!strangers->found) {
    const std::string why = state->counters.foreign_packets == 0 ? "" : " (" + state->warnings.back() + ")";
    return tl::unexpected(no_such_packets(*strangers, **decoder, name, "packets in it") + why);
  }
  state->counters = {};
  if (const auto rewound = packets->rewind(); !rewound) return tl::unexpected(rewound.error());
  return std::make_unique<PacketSweepSource>(std::move(state), std::move(packets), std::move(*decoder),
                                             options);
}

}  // namespace

SourceResult open_bag_source(const services::SourceUri& uri, const SourceOptions& options) {
  auto topic = open_topic(uri);
  if (!topic) return tl::unexpected(topic.error());
  if (const auto checked = services::check_options(uri, options_of(topic->kind)); !checked)
    return tl::unexpected(checked.error());
  if (topic->kind == Kind::cloud) return open_clouds(uri, options, topic->name, std::move(topic->reader));
  return open_packets(uri, options, topic->name, std::move(topic->reader), topic->kind);
}

tl::expected<std::unique_ptr<PacketSource>, std::string> open_bag_packets(const std::string& uri,
                                                                          SourceState& state) {
  const auto parsed = services::parse_source_uri(uri);
  if (!parsed) return tl::unexpected(parsed.error());
  if (const auto checked = services::check_options(*parsed, {"topic"}); !checked)
    return tl::unexpected(checked.error());
  auto topic = open_topic(*parsed);
  if (!topic) return tl::unexpected(topic.error());
  if (topic->kind == Kind::cloud) return tl::unexpected(topic->name + ": has clouds, and no packets");
  return std::make_unique<BagPackets>(std::move(topic->reader), messages_of(topic->kind), topic->name, state);
}

}  // namespace gvom::ingest
