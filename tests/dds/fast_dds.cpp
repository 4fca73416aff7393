#include "tests/dds/fast_dds.hpp"

#include <algorithm>
#include <memory>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

namespace gvom::dds::test {

constexpr std::uint32_t kSocketBuffer = 4 << 20;

RawType::RawType(const std::string& name) {
  setName(name.c_str());
  m_typeSize = 1 << 20;  // grows
}

bool RawType::serialize(void* data, rtps::SerializedPayload_t* payload) {
  const Bytes& bytes = *static_cast<Bytes*>(data);
  payload->encapsulation = CDR_LE;
  payload->length = static_cast<std::uint32_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), payload->data);
  return true;
}

bool RawType::deserialize(rtps::SerializedPayload_t* payload, void* data) {
  static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
  return true;
}

std::function<std::uint32_t()> RawType::getSerializedSizeProvider(void* data) {
  return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
}

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
                        const std::string& type_name, const std::string& topic) {
  const fast::TypeSupport support(type);
  support.register_type(participant, type_name);
  return participant->create_topic(topic, type_name, fast::TOPIC_QOS_DEFAULT);
}

fast::DataReader* hear(fast::DomainParticipant* participant, fast::Topic* topic, bool latched,
                       fast::DataReaderListener* ear) {
  fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
  qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
  if (latched) qos.durability().kind = fast::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 1;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  fast::Subscriber* const subscriber = participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  return subscriber->create_datareader(topic, qos, ear);
}

fast::DataWriter* make_writer(fast::DomainParticipant* participant, fast::Topic* topic,
                              fast::DataWriterListener* mouth, bool latched) {
  fast::DataWriterQos qos = fast::DATAWRITER_QOS_DEFAULT;
  qos.reliability().kind = latched ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
  if (latched) qos.durability().kind = fast::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.history().depth = 1;
  qos.publish_mode().kind = fast::SYNCHRONOUS_PUBLISH_MODE;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  return participant->create_publisher(fast::PUBLISHER_QOS_DEFAULT)->create_datawriter(topic, qos, mouth);
}

}  // namespace gvom::dds::test
