// Messages of ROS 2, live or of a bag, that a source can't use.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "services/ingest/packet.hpp"

namespace gvom::ingest {

class UnusedMessages {
 public:
  /// Counts one of `size_bytes` as `foreign_packets`. The first is told: `where` is the source, and of a bag
  /// also the message's number.
  void add(SourceState& state, const std::string& where, const std::string& why, std::uint64_t size_bytes) {
    SourceCounters& counters = state.counters;
    if (++counters.foreign_packets > 1 && counters.foreign_size != size_bytes)
      ++counters.foreign_size_changes;
    counters.foreign_size = size_bytes;
    if (!std::exchange(told_, true))
      state.warnings.push_back(where + ": " + why + ": it is not used, and neither are others like it");
  }

 private:
  bool told_ = false;
};

}  // namespace gvom::ingest
