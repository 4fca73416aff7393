// Whether packets are of the mode that the metadata tells of: the size of a packet does not say it.
#pragma once

#include <cstdint>

#include "services/ingest/ouster_metadata.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

/// True if the packet's own columns prove that a turn has another number of columns than the metadata says,
/// or takes another time, or that they are sent outside of its window; `why` says how. Half the columns on a
/// whole turn would lie at wrong azimuths.
bool is_of_other_mode(const OusterMetadata& metadata, const std::uint8_t* packet, KindText& why);

}  // namespace gvom::ingest
