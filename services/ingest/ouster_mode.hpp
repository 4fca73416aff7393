// What the columns of a packet tell together: its mode, which the size does not say, its frame and its time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/ingest/ouster_metadata.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

/// True if the packet's own columns prove that a turn has another number of columns than the metadata says,
/// or takes another time, or that they are sent outside of its window; `why` says how. Half the columns on a
/// whole turn would lie at wrong azimuths.
bool is_of_other_mode(const OusterMetadata& metadata, const std::uint8_t* packet, KindText& why);

/// The frame of a packet; nothing if it holds no valid column to tell it.
std::optional<std::uint16_t> frame_of(const OusterMetadata& metadata, const std::uint8_t* packet);

/// The middle one of the times of its valid columns; 0 without one. `scratch` has room for all its columns.
std::uint64_t middle_time_ns(const OusterMetadata& metadata, const std::uint8_t* packet,
                             std::vector<std::uint64_t>& scratch);

}  // namespace gvom::ingest
