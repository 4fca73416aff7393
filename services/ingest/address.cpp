#include "services/ingest/address.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <cstring>

namespace gvom::ingest {

namespace {

constexpr std::size_t kIpv4At = 12;  // in ::ffff:a.b.c.d

}  // namespace

Address ipv4_address(const std::uint8_t* bytes) {
  Address out{};
  out[10] = out[11] = 0xFF;
  std::copy_n(bytes, 4, out.begin() + kIpv4At);
  return out;
}

Address ipv6_address(const std::uint8_t* bytes) {
  Address out;
  std::copy_n(bytes, out.size(), out.begin());
  return out;
}

Address address_of(const sockaddr_storage& socket_address) {
  if (socket_address.ss_family == AF_INET) {
    const auto& ipv4 = reinterpret_cast<const sockaddr_in&>(socket_address);
    return ipv4_address(reinterpret_cast<const std::uint8_t*>(&ipv4.sin_addr));
  }
  return ipv6_address(reinterpret_cast<const sockaddr_in6&>(socket_address).sin6_addr.s6_addr);
}

bool is_ipv4(const Address& address) {
  static const Address kMapped = ipv4_address(std::array<std::uint8_t, 4>{}.data());
  return std::equal(address.begin(), address.begin() + kIpv4At, kMapped.begin());
}

bool is_multicast(const Address& address) {
  return is_ipv4(address) ? address[kIpv4At] >> 4 == 0xE : address[0] == 0xFF;
}

std::optional<Address> parse_address(const std::string& text) {
  std::uint8_t bytes[16];
  if (::inet_pton(AF_INET, text.c_str(), bytes) == 1) return ipv4_address(bytes);
  if (::inet_pton(AF_INET6, text.c_str(), bytes) == 1) return ipv6_address(bytes);
  return std::nullopt;
}

AddressText to_text(const Address& address) {
  AddressText text{};
  if (is_ipv4(address)) {
    ::inet_ntop(AF_INET, address.data() + kIpv4At, text.data(), text.size());
  } else {
    ::inet_ntop(AF_INET6, address.data(), text.data(), text.size());
  }
  return text;
}

SocketAddress socket_address(const Address& address, std::uint16_t port, unsigned scope) {
  SocketAddress out;
  if (is_ipv4(address)) {
    auto& ipv4 = reinterpret_cast<sockaddr_in&>(out.storage);
    ipv4.sin_family = AF_INET;
    ipv4.sin_port = htons(port);
    std::memcpy(&ipv4.sin_addr, address.data() + kIpv4At, sizeof ipv4.sin_addr);
    out.size = sizeof ipv4;
    return out;
  }
  auto& ipv6 = reinterpret_cast<sockaddr_in6&>(out.storage);
  ipv6.sin6_family = AF_INET6;
  ipv6.sin6_port = htons(port);
  ipv6.sin6_scope_id = scope;
  std::memcpy(&ipv6.sin6_addr, address.data(), address.size());
  out.size = sizeof ipv6;
  return out;
}

}  // namespace gvom::ingest
