// Whose messages of a topic are used, where several publish it.
#pragma once

#include <cstdint>
#include <optional>

namespace gvom::dds {

/// The first publisher has the topic until it has been silent for a second.
class TopicOwner {
 public:
  /// Of a Message: its publisher, and when it arrived.
  bool is_owner(std::uint64_t publisher, std::int64_t arrived_ns) {
    constexpr std::int64_t kSilence_ns = 1'000'000'000;
    if (!owner_ || (*owner_ != publisher && arrived_ns - heard_ns_ > kSilence_ns)) owner_ = publisher;
    if (*owner_ != publisher) return false;
    heard_ns_ = arrived_ns;
    return true;
  }

 private:
  std::optional<std::uint64_t> owner_;
  std::int64_t heard_ns_ = 0;
};

}  // namespace gvom::dds
