// Addresses of the network, IPv4 and IPv6 alike.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <netinet/in.h>
#include <sys/socket.h>

namespace gvom::ingest {

/// An IPv6 address; an IPv4 one as ::ffff:a.b.c.d.
using Address = std::array<std::uint8_t, 16>;

Address ipv4_address(const std::uint8_t* bytes);
Address ipv6_address(const std::uint8_t* bytes);

/// The address in an AF_INET or AF_INET6 socket address.
Address address_of(const sockaddr_storage& socket_address);

[[nodiscard]] bool is_ipv4(const Address& address);
[[nodiscard]] bool is_multicast(const Address& address);

/// "192.168.1.7", "fe80::1"; nothing if it is none.
std::optional<Address> parse_address(const std::string& text);
using AddressText = std::array<char, INET6_ADDRSTRLEN>;
AddressText to_text(const Address& address);

/// With `port`, in the family that the address is of. `scope`: the interface of an IPv6 link-local address.
struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;

  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
};
SocketAddress socket_address(const Address& address, std::uint16_t port, unsigned scope = 0);

}  // namespace gvom::ingest
