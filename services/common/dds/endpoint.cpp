#include "services/common/dds/endpoint.hpp"

#include <algorithm>

#include "services/common/dds/blob_type.hpp"

namespace gvom::dds {

tl::expected<OpenTopic, std::string> open_topic(dds_entity_t participant, const std::string& name,
                                                const std::string& type) {
  OpenTopic topic;
  ddsi_sertype* sertype = new_blob_type(type.c_str());
  topic.entity =
      Entity(dds_create_topic_sertype(participant, name.c_str(), &sertype, nullptr, nullptr, nullptr));
  if (!topic.entity.valid()) {
    ddsi_sertype_unref(sertype);
    return tl::unexpected("topic " + name + ": " + dds_strretcode(topic.entity.get()));
  }
  topic.type = sertype;
  return topic;
}

tl::expected<OpenTopic, std::string> open_topic(dds_entity_t participant, const Topic& topic) {
  const auto name = topic_on_wire(topic.name);
  if (!name) return tl::unexpected(name.error());
  const auto type = type_on_wire(topic.type);
  if (!type) return tl::unexpected(type.error());
  return open_topic(participant, *name, *type);
}

QosPtr make_qos(const Qos& qos, const std::string& user_data) {
  QosPtr out(dds_create_qos());
  // A writer never waits for a reader: with a depth, a new message replaces one that nobody confirmed.
  dds_qset_reliability(out.get(), qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(out.get(), qos.latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(out.get(), DDS_HISTORY_KEEP_LAST, qos.depth);
  dds_qset_durability_service(out.get(), 0, DDS_HISTORY_KEEP_LAST, qos.depth, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_writer_data_lifecycle(out.get(), false);
  if (!user_data.empty()) dds_qset_userdata(out.get(), user_data.data(), user_data.size());
  return out;
}

std::string user_data_of(const std::string& type_hash, Distro distro) {
  if (distro == Distro::humble || type_hash.empty()) return {};
  return "typehash=" + type_hash + ";";
}

Guid guid_of(dds_entity_t entity) {
  dds_guid_t guid{};
  dds_get_guid(entity, &guid);
  Guid out{};
  std::copy(std::begin(guid.v), std::end(guid.v), out.begin());
  return out;
}

}  // namespace gvom::dds
