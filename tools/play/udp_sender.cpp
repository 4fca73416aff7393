#include "tools/play/udp_sender.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace gvom::play {

namespace {

/// Multicast goes out by that interface.
bool choose_interface(int socket, int family, unsigned interface) {
  const ip_mreqn ipv4{{}, {}, static_cast<int>(interface)};
  if (family == AF_INET) return ::setsockopt(socket, IPPROTO_IP, IP_MULTICAST_IF, &ipv4, sizeof ipv4) == 0;
  return ::setsockopt(socket, IPPROTO_IPV6, IPV6_MULTICAST_IF, &interface, sizeof interface) == 0;
}

}  // namespace

tl::expected<UdpSender, std::string> UdpSender::open(const std::string& host, const std::string& interface) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(host.c_str(), nullptr, &hints, &found); error != 0)
    return tl::make_unexpected(host + ": no such host: " + ::gai_strerror(error));
  UdpSender sender(::socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sender.to_size_ = found->ai_addrlen;
  std::memcpy(&sender.to_, found->ai_addr, found->ai_addrlen);
  ::freeaddrinfo(found);
  if (sender.socket_ < 0)
    return tl::make_unexpected(std::string("cannot make a socket: ") + std::strerror(errno));
  if (interface.empty()) return sender;
  const unsigned index = ::if_nametoindex(interface.c_str());
  if (index == 0 || !choose_interface(sender.socket_, sender.to_.ss_family, index))
    return tl::make_unexpected("interface " + interface + ": " + std::strerror(errno));
  return sender;
}

UdpSender::UdpSender(UdpSender&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), to_(other.to_), to_size_(other.to_size_) {}

UdpSender::~UdpSender() {
  if (socket_ >= 0) ::close(socket_);
}

bool UdpSender::send(const std::uint8_t* data, std::size_t size, std::uint16_t port) {
  // Where a sockaddr_in6 has its port, a sockaddr_in has it too.
  reinterpret_cast<sockaddr_in6&>(to_).sin6_port = htons(port);
  const auto sent = ::sendto(socket_, data, size, 0, reinterpret_cast<const sockaddr*>(&to_), to_size_);
  return sent == static_cast<ssize_t>(size);
}

}  // namespace gvom::play
