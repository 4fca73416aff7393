// Datagrams to one host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <sys/socket.h>
#include <tl/expected.hpp>

namespace gvom::play {

class UdpSender {
 public:
  /// `host`: a name, an IPv4 or IPv6 address, or a multicast group, to which packets go out by `interface`
  /// (if that is empty, by the one that the routes say) and no further than the network there. Errors name
  /// them.
  static tl::expected<UdpSender, std::string> open(const std::string& host,
                                                   const std::string& interface = "");

  UdpSender(UdpSender&& other) noexcept;
  UdpSender& operator=(UdpSender&&) = delete;
  ~UdpSender();

  /// False if the system would not take the datagram (larger than 65507 bytes, no route). Nobody need listen.
  bool send(const std::uint8_t* data, std::size_t size, std::uint16_t port);

 private:
  explicit UdpSender(int socket) : socket_(socket) {}

  int socket_;
  sockaddr_storage to_{};
  socklen_t to_size_ = 0;
};

}  // namespace gvom::play
