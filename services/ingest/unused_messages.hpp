// Messages of ROS 2, live or of a bag, that a source can't use.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "services/ingest/packet.hpp"

namespace gvom::ingest {

class UnusedMessages {
 public:
  /// Counts one of `size_bytes` as `foreign_packets`, and why. The first, tenth, hundredth and so on is also
  /// told: `where` is the source, and of a bag also the message's number.
  void add(SourceState& state, const std::string& where, const std::string& why, std::uint64_t size_bytes) {
    SourceCounters& counters = state.counters;
    if (++counters.foreign_packets > 1 && counters.foreign_size != size_bytes)
      ++counters.foreign_size_changes;
    counters.foreign_size = size_bytes;
    std::snprintf(counters.refusal.data(), counters.refusal.size(), "%s", why.c_str());
    if (++count_ != next_told_) return;
    next_told_ *= 10;
    state.warnings.push_back(where + ": " + why + ": it is not used" +
                             (count_ == 1 ? "" : ", as " + std::to_string(count_ - 1) + " before it"));
  }

 private:
  std::uint64_t count_ = 0;
  std::uint64_t next_told_ = 1;
};

}  // namespace gvom::ingest
