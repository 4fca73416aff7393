// The socket on which a live sensor's packets come in.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "services/common/source_uri.hpp"
#include "services/ingest/address.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

inline constexpr int kWantedBuffer = 16 << 20;     // bytes, of the kernel's receive buffer
inline constexpr int kSufficientBuffer = 4 << 20;  // about 0.1 s of the largest sensors

/// Where packets are taken from. Without `bind` and `group`: to every address of this machine, IPv4 and IPv6.
struct UdpOptions {
  std::uint16_t port = 0;
  std::optional<Address> bind;   ///< One of this machine's addresses.
  std::optional<Address> group;  ///< A multicast group, that is joined.
  std::string interface;         ///< Joined there; without a group: packets that come in there only.
};

/// The options of `ouster-udp:PORT?...` and `velodyne-udp:PORT?...`: bind, group, interface, from. Errors
/// name the option. A link-local IPv6 address may name its interface: `bind=fe80::1%eth1`.
tl::expected<UdpOptions, SourceError> udp_options(const services::SourceUri& uri);

/// The option `from`: the sensor's address.
tl::expected<std::optional<Address>, SourceError> from_option(const services::SourceUri& uri);

/// A bound socket, which the caller closes. Warns if the kernel grants a receive buffer too small for a
/// burst. Errors: no such interface, an address that is not up, a port that is taken, a group that is not
/// joined.
tl::expected<int, SourceError> open_udp_socket(const UdpOptions& options, std::vector<std::string>& warnings);

/// The interface on which the kernel now joins a group for which none is named; empty if no route leads to
/// it.
std::string interface_towards(const Address& group);

/// "UDP port 7502 of group 239.201.201.201 on eth1", for messages.
std::string to_text(const UdpOptions& options);

}  // namespace gvom::ingest
