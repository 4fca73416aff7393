#include "tools/play/udp_sender.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

namespace gvom::play {

tl::expected<UdpSender, std::string> UdpSender::open(const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(host.c_str(), nullptr, &hints, &found); error != 0)
    return tl::make_unexpected(host + ": no such host: " + ::gai_strerror(error));
  sockaddr_in to{};
  std::memcpy(&to, found->ai_addr, sizeof to);
  ::freeaddrinfo(found);

  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return tl::make_unexpected(std::string("cannot make a socket: ") + std::strerror(errno));
  return UdpSender(socket, to);
}

UdpSender::UdpSender(UdpSender&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), to_(other.to_) {}

UdpSender::~UdpSender() {
  if (socket_ >= 0) ::close(socket_);
}

bool UdpSender::send(const std::uint8_t* data, std::size_t size, std::uint16_t port) {
  to_.sin_port = htons(port);
  const auto sent = ::sendto(socket_, data, size, 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_);
  return sent == static_cast<ssize_t>(size);
}

}  // namespace gvom::play
