// How Cyclone sends and receives messages that are serialised already: nothing is copied on the way out.
#pragma once

#include <cstdint>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include "services/common/ros/blob.hpp"

namespace gvom::dds {

/// A new type without key, of CDR in its first version. Give it to dds_create_topic_sertype, or free it by
/// ddsi_sertype_unref.
ddsi_sertype* new_blob_type(const char* type_on_wire);

/// A message of the writer's type, for dds_writecdr, which takes it. It holds the blob until all have it.
ddsi_serdata* new_message(const ddsi_sertype* type, ros::Blob cdr);

/// What came: a message that dds_takecdr gave for a reader of such a type. Null where it says only that a
/// writer has gone.
ros::Blob blob_of(const ddsi_serdata* message);

/// The number that its writer gave it, one more for each; 0 if it is not known.
std::int64_t sequence_of(const ddsi_serdata* message);

}  // namespace gvom::dds
