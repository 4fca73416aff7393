// A process that is not ours and speaks DDS: Fast DDS, with types that its own generator made. One line on
// stdout for each thing that happens; ends when its stdin does.
//   dds_peer DOMAIN hear-grid TOPIC
//   dds_peer DOMAIN hear-cloud TOPIC
//   dds_peer DOMAIN hear-graph
//   dds_peer DOMAIN send-cloud TOPIC POINTS    (one for each line on stdin)
//   dds_peer DOMAIN send-file TOPIC FILE TYPE  (likewise its messages: a size in four bytes, then CDR)
#include <cstdlib>
#include <fstream>

#include "messagesPubSubTypes.h"
#include "tests/dds/fast_dds.hpp"

namespace {

using namespace gvom::dds::test;

std::string hex(const void* bytes, std::size_t size) {
  std::string text;
  for (std::size_t i = 0; i < size; ++i) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", static_cast<const unsigned char*>(bytes)[i]);
    text += digits;
  }
  return text;
}

std::string hex(const rtps::GUID_t& guid) {
  return hex(guid.guidPrefix.value, 12) + hex(guid.entityId.value, 4);
}

unsigned long long sum_of(const std::vector<std::uint8_t>& data) {
  unsigned long long sum = 0;
  for (const std::uint8_t byte : data) sum = sum * 31 + byte;
  return sum;
}

void tell(const Grid& grid) {
  say("grid %u x %u of %g m at %d.%09u in %s, cost %llu", grid.width(), grid.height(), grid.resolution(),
      grid.heading().stamp().sec(), grid.heading().stamp().nanosec(), grid.heading().frame_id().c_str(),
      sum_of(grid.data()));
}

void tell(const Cloud& cloud) {
  say("cloud %u of %zu bytes at %d, sum %llu", cloud.width(), cloud.data().size(),
      cloud.heading().stamp().sec(), sum_of(cloud.data()));
}

void tell(const Graph& graph) {
  for (const Node& node : graph.nodes()) {
    std::string line =
        "node " + node.space() + " " + node.name() + " of " + hex(graph.gid().data().data(), 16);
    for (const Gid& gid : node.readers()) line += " reads " + hex(gid.data().data(), 16);
    for (const Gid& gid : node.writers()) line += " writes " + hex(gid.data().data(), 16);
    say("%s", line.c_str());
  }
}

template <typename Message>
class Ear : public fast::DataReaderListener {
 public:
  void on_data_available(fast::DataReader* reader) override {
    Message message;
    fast::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK)
      if (info.valid_data) tell(message);
  }
  void on_subscription_matched(fast::DataReader*, const fast::SubscriptionMatchedStatus& status) override {
    say("matched %d", status.current_count);
  }
};

/// Says what others offer.
class Discovery : public fast::DomainParticipantListener {
  void on_publisher_discovery(fast::DomainParticipant*, rtps::WriterDiscoveryInfo&& found) override {
    if (found.status != rtps::WriterDiscoveryInfo::DISCOVERED_WRITER) return;
    const auto& data = found.info.m_qos.m_userData.data_vec();
    const std::string user_data(data.begin(), data.end());
    say("writer %s of %s is %s, user data %s", found.info.topicName().c_str(), found.info.typeName().c_str(),
        hex(found.info.guid()).c_str(), user_data.c_str());
  }
};

/// Points of 32 bytes; the stamp says which cloud of them all it is.
Cloud make_cloud(int number, unsigned points) {
  Cloud cloud;
  cloud.heading().stamp().sec(number);
  cloud.heading().frame_id("os_sensor");
  cloud.height(1);
  cloud.width(points);
  cloud.point_step(32);
  cloud.row_step(32 * points);
  cloud.data().resize(std::size_t{32} * points);
  for (std::size_t i = 0; i < cloud.data().size(); ++i)
    cloud.data()[i] = static_cast<std::uint8_t>(i * 7 + static_cast<std::size_t>(number));
  cloud.is_dense(true);
  return cloud;
}

void send_clouds(fast::DataWriter* writer, unsigned points) {
  for (int number = 0; std::fgetc(stdin) != EOF; ++number) {
    Cloud cloud = make_cloud(number, points);
    const bool sent = writer->write(&cloud);
    say("%s %d, sum %llu", sent ? "sent" : "refused", number, sum_of(cloud.data()));
  }
}

void send_file(fast::DataWriter* writer, const char* path) {
  std::ifstream file(path, std::ios::binary);
  std::uint32_t size = 0;
  while (std::fgetc(stdin) != EOF && file.read(reinterpret_cast<char*>(&size), sizeof size)) {
    Bytes message(size);
    file.read(reinterpret_cast<char*>(message.data()), size);
    say("%s", writer->write(&message) ? "sent" : "refused");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 64;
  const std::string mode = argv[2];
  const std::string topic = argc > 3 ? std::string("rt") + argv[3] : "";
  Discovery discovery;
  Ear<Grid> grids;
  Ear<Cloud> clouds;
  Ear<Graph> graphs;
  Mouth mouth;
  fast::DomainParticipant* const participant =
      join(std::atoi(argv[1]), mode == "hear-graph" ? &discovery : nullptr);
  if (participant == nullptr) return 69;
  constexpr const char* kCloud = "sensor_msgs::msg::dds_::PointCloud2_";
  if (mode == "hear-grid")
    hear(participant,
         open_topic(participant, new GridPubSubType, "nav_msgs::msg::dds_::OccupancyGrid_", topic), true,
         &grids);
  if (mode == "hear-cloud")
    hear(participant, open_topic(participant, new CloudPubSubType, kCloud, topic), false, &clouds);
  if (mode == "hear-graph")
    hear(participant,
         open_topic(participant, new GraphPubSubType, "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_",
                    "ros_discovery_info"),
         true, &graphs);
  fast::DataWriter* writer = nullptr;
  if (mode == "send-file")
    writer = make_writer(participant, open_topic(participant, new RawType(argv[5]), argv[5], topic), &mouth);
  if (mode == "send-cloud")
    writer = make_writer(participant, open_topic(participant, new CloudPubSubType, kCloud, topic), &mouth);
  say("ready");
  if (mode == "send-file") send_file(writer, argv[4]);
  if (mode == "send-cloud") send_clouds(writer, static_cast<unsigned>(std::atoi(argv[4])));
  while (std::fgetc(stdin) != EOF) continue;
  std::_Exit(0);
}
