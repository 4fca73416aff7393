// A process that is not ours and speaks DDS: Fast DDS, with types that its own generator made. One line on
// stdout for each thing that happens; ends when its stdin does.
//   dds_peer DOMAIN hear-grid TOPIC
//   dds_peer DOMAIN hear-cloud TOPIC
//   dds_peer DOMAIN hear-graph
//   dds_peer DOMAIN send-cloud TOPIC POINTS    (one for each line on stdin)
//   dds_peer DOMAIN send-file TOPIC FILE TYPE  (likewise its messages: a size in four bytes, then CDR)
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include "messagesPubSubTypes.h"

namespace {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

constexpr std::uint32_t kSocketBuffer = 4 << 20;

/// One line, whole, whichever thread says it.
template <typename... Args>
void say(const char* format, Args... args) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  std::printf(format, args...);
  std::printf("\n");
  std::fflush(stdout);
}

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

class Mouth : public fast::DataWriterListener {
  void on_publication_matched(fast::DataWriter*, const fast::PublicationMatchedStatus& status) override {
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

using Bytes = std::vector<std::uint8_t>;

/// Messages that are serialised already.
class RawType : public fast::TopicDataType {
 public:
  explicit RawType(const char* name) {
    setName(name);
    m_typeSize = 1 << 20;
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<Bytes*>(data);
    payload->encapsulation = CDR_LE;
    payload->length = static_cast<std::uint32_t>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), payload->data);
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t*, void*) override { return false; }
  std::function<uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

fast::DomainParticipant* join(int domain, fast::DomainParticipantListener* listener) {
  fast::DomainParticipantQos qos = fast::PARTICIPANT_QOS_DEFAULT;
  const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  udp->receiveBufferSize = kSocketBuffer;
  udp->sendBufferSize = kSocketBuffer;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  // With a mask the participant's listener would take the readers' data, too.
  return fast::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<fast::DomainId_t>(domain), qos, listener, fast::StatusMask::none());
}

fast::Topic* open_topic(fast::DomainParticipant* participant, fast::TopicDataType* type,
                        const char* type_name, const std::string& topic) {
  const fast::TypeSupport support(type);
  support.register_type(participant, type_name);
  return participant->create_topic(topic, type_name, fast::TOPIC_QOS_DEFAULT);
}

/// Reliable, and the newest one of those who were there before, if it is latched.
void hear(fast::DomainParticipant* participant, fast::Topic* topic, bool latched,
          fast::DataReaderListener* ear) {
  fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
  qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
  if (latched) qos.durability().kind = fast::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 1;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  fast::Subscriber* const subscriber = participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  if (subscriber->create_datareader(topic, qos, ear) == nullptr) say("no reader");
}

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

/// As drivers do: best effort.
fast::DataWriter* make_writer(fast::DomainParticipant* participant, fast::Topic* topic, Mouth* mouth) {
  fast::DataWriterQos qos = fast::DATAWRITER_QOS_DEFAULT;
  qos.reliability().kind = fast::BEST_EFFORT_RELIABILITY_QOS;
  qos.history().depth = 1;
  qos.publish_mode().kind = fast::SYNCHRONOUS_PUBLISH_MODE;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  return participant->create_publisher(fast::PUBLISHER_QOS_DEFAULT)->create_datawriter(topic, qos, mouth);
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
