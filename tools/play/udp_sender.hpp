// Datagrams to one host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <netinet/in.h>
#include <tl/expected.hpp>

namespace gvom::play {

class UdpSender {
 public:
  /// `host`: a name or an IPv4 address. Errors name it.
  static tl::expected<UdpSender, std::string> open(const std::string& host);

  UdpSender(UdpSender&& other) noexcept;
  UdpSender& operator=(UdpSender&&) = delete;
  ~UdpSender();

  /// False if the system would not take the datagram (larger than 65507 bytes, no route). Nobody need listen.
  bool send(const std::uint8_t* data, std::size_t size, std::uint16_t port);

 private:
  UdpSender(int socket, const sockaddr_in& to) : socket_(socket), to_(to) {}
  int socket_;
  sockaddr_in to_;
};

}  // namespace gvom::play
