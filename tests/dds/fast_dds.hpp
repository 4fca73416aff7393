// Fast DDS for the peers of the tests: who joins over the loopback, and messages that are serialised already.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

namespace gvom::dds::test {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

/// One line, whole, whichever thread says it.
template <typename... Args>
void say(const char* format, Args... args) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  std::printf(format, args...);
  std::printf("\n");
  std::fflush(stdout);
}

using Bytes = std::vector<std::uint8_t>;

/// Messages that are serialised already: Bytes, with CDR's head of four bytes.
class RawType : public fast::TopicDataType {
 public:
  explicit RawType(const std::string& name);
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override;
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

/// Says how many readers it has.
class Mouth : public fast::DataWriterListener {
  void on_publication_matched(fast::DataWriter*, const fast::PublicationMatchedStatus& status) override {
    say("matched %d", status.current_count);
  }
};

/// Null if the domain cannot be joined.
fast::DomainParticipant* join(int domain, fast::DomainParticipantListener* listener = nullptr);

fast::Topic* open_topic(fast::DomainParticipant* participant, fast::TopicDataType* type,
                        const std::string& type_name, const std::string& topic);

/// A reader as RViz's: reliable, and the newest one of those who were there before, if it is latched.
fast::DataReader* hear(fast::DomainParticipant* participant, fast::Topic* topic, bool latched,
                       fast::DataReaderListener* ear);

/// A writer as drivers have it: best effort. Latched: reliable, and its newest message is for those who come
/// later.
fast::DataWriter* make_writer(fast::DomainParticipant* participant, fast::Topic* topic,
                              fast::DataWriterListener* mouth, bool latched = false);

}  // namespace gvom::dds::test
