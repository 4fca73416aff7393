#include "services/ingest/ros2_source.hpp"

#include <set>
#include <string>
#include <utility>

#include "services/common/dds/network_options.hpp"
#include "services/common/dds/reader.hpp"
#include "services/common/ros/schemas.hpp"
#include "services/ingest/make_decoder.hpp"
#include "services/ingest/packet_sweep_source.hpp"
#include "services/ingest/ros2_clouds.hpp"
#include "services/ingest/ros2_packets.hpp"

namespace gvom::ingest {
namespace {

using SourceResult = tl::expected<std::unique_ptr<Source>, SourceError>;
using ReaderResult = tl::expected<dds::Reader, SourceError>;

SourceError wrong(const services::SourceUri& uri, const std::string& why) {
  return "source '" + uri.text + "': " + why;
}

/// `depth`: messages that wait while the sweep before is mapped.
ReaderResult open_reader(const services::SourceUri& uri, const std::string& type, int depth) {
  const auto options = dds::network_options(uri.options, "/gvom_ingest", uri.path);
  if (!options) return tl::unexpected(wrong(uri, options.error()));
  const dds::Topic topic{uri.path, type, ros::type_hash_of(type).value_or("")};
  if (const auto name = dds::topic_on_wire(topic.name); !name)
    return tl::unexpected(wrong(uri, name.error()));
  if (const auto name = dds::type_on_wire(topic.type); !name) return tl::unexpected(wrong(uri, name.error()));
  const auto participant = dds::Participant::open(*options);
  if (!participant)
    return tl::unexpected(SourceError(wrong(uri, participant.error()).what, SourceError::Kind::unavailable));
  auto reader = dds::Reader::open(*participant, topic, {false, false, depth});
  if (!reader) return tl::unexpected(wrong(uri, reader.error()));
  return std::move(*reader);
}

tl::expected<void, SourceError> check(const services::SourceUri& uri, const std::set<std::string>& own) {
  std::set<std::string> allowed = dds::kNetworkOptions;
  allowed.insert(own.begin(), own.end());
  if (const auto checked = services::check_options(uri, allowed); !checked)
    return tl::unexpected(checked.error());
  return {};
}

SourceResult open_clouds(const services::SourceUri& uri, const SourceOptions& options) {
  if (const auto checked = check(uri, {"deskew", "time"}); !checked) return tl::unexpected(checked.error());
  if (options.by_arrival)
    return tl::unexpected(wrong(uri, "clock: arrival needs packets; clouds have no times of arrival"));
  const auto clouds = cloud_options(uri, options.max_returns);
  if (!clouds) return tl::unexpected(clouds.error());
  constexpr int kDepth = 5;
  auto reader = open_reader(uri, "sensor_msgs/msg/PointCloud2", kDepth);
  if (!reader) return tl::unexpected(reader.error());
  return std::make_unique<Ros2Clouds>(std::move(*reader), "ros2 " + uri.path, *clouds,
                                      options.clock_offset_ns);
}

SourceResult open_packets(const services::SourceUri& uri, const SourceOptions& options, PacketMessages kind) {
  const bool ouster = kind == PacketMessages::ouster;
  std::set<std::string> own(ouster ? kOusterOptions : kVelodyneOptions);
  if (ouster) own.insert("type");
  if (const auto checked = check(uri, own); !checked) return tl::unexpected(checked.error());
  auto state = std::make_unique<SourceState>();
  auto decoder =
      ouster ? make_ouster_decoder(uri, options, *state) : make_velodyne_decoder(uri, options, *state);
  if (!decoder) return tl::unexpected(decoder.error());
  const std::string type = ouster ? uri.option("type").value_or("ouster_sensor_msgs/msg/PacketMsg")
                                  : "velodyne_msgs/msg/VelodyneScan";
  const int depth = ouster ? 1024 : 16;  // half a second at least
  auto reader = open_reader(uri, type, depth);
  if (!reader) return tl::unexpected(reader.error());
  auto packets = std::make_unique<Ros2Packets>(std::move(*reader), kind, "ros2 " + uri.path, *state);
  return std::make_unique<PacketSweepSource>(std::move(state), std::move(packets), std::move(*decoder),
                                             options);
}

}  // namespace

SourceResult open_ros2_source(const services::SourceUri& uri, const SourceOptions& options) {
  if (uri.option("meta") && uri.option("model"))
    return tl::unexpected(wrong(uri, "meta is an Ouster's, model a Velodyne's: which is it?"));
  if (uri.option("meta")) return open_packets(uri, options, PacketMessages::ouster);
  if (uri.option("model")) return open_packets(uri, options, PacketMessages::velodyne);
  return open_clouds(uri, options);
}

}  // namespace gvom::ingest
