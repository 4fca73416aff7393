// Whose messages of a ROS 2 topic are used, where several publish it.
#pragma once

#include <cstdint>
#include <optional>

#include "services/ingest/address.hpp"

namespace gvom::ingest {

/// The first publisher has the topic until it has been silent for a second.
class TopicOwner {
 public:
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

/// DDS tells publishers apart by numbers; in place of an address, and no network has such a one.
inline Address address_of_publisher(std::uint64_t publisher) {
  Address address{};
  for (std::size_t i = 0; i < sizeof publisher; ++i)
    address[address.size() - 1 - i] = static_cast<std::uint8_t>(publisher >> 8 * i);
  return address;
}

}  // namespace gvom::ingest
