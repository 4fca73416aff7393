// What readers and writers have in common: a topic, its type and how its messages are kept.
#pragma once

#include <memory>
#include <string>

#include <dds/dds.h>
#include <tl/expected.hpp>

#include "services/common/dds/entity.hpp"
#include "services/common/dds/graph.hpp"
#include "services/common/dds/names.hpp"
#include "services/common/dds/qos.hpp"

struct ddsi_sertype;

namespace gvom::dds {

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosPtr = std::unique_ptr<dds_qos_t, QosDeleter>;

/// A topic of Cyclone's and the type that it got, which lives as long.
struct OpenTopic {
  Entity entity;
  ddsi_sertype* type = nullptr;
};

/// Names as they are on the wire.
tl::expected<OpenTopic, std::string> open_topic(dds_entity_t participant, const std::string& name,
                                                const std::string& type);

/// The same by the names of ROS.
tl::expected<OpenTopic, std::string> open_topic(dds_entity_t participant, const Topic& topic);

/// What `qos` says in Cyclone's terms; `user_data` may be empty.
QosPtr make_qos(const Qos& qos, const std::string& user_data);

/// "typehash=RIHS01_...;" where ROS has such a thing and the hash is known; else empty.
std::string user_data_of(const std::string& type_hash, Distro distro);

Guid guid_of(dds_entity_t entity);

}  // namespace gvom::dds
