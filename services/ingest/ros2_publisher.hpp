// A publisher of ROS 2 where packets have a sender.
#pragma once

#include <cstddef>
#include <cstdint>

#include "services/ingest/address.hpp"

namespace gvom::ingest {

/// DDS tells publishers apart by numbers; in place of an address, and no network has such a one.
inline Address address_of_publisher(std::uint64_t publisher) {
  Address address{};
  for (std::size_t i = 0; i < sizeof publisher; ++i)
    address[address.size() - 1 - i] = static_cast<std::uint8_t>(publisher >> 8 * i);
  return address;
}

}  // namespace gvom::ingest
