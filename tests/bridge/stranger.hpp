// Sockets that say what they like, or hold a port.
#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <string>

#include "tests/support/local_address.hpp"

namespace gvom::test {

/// A websocket's handshake for 127.0.0.1, up to the empty line. `headers`: more of them, each with its line's
/// end.
inline std::string upgrade(const std::string& headers) {
  return "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n" +
         headers + "\r\n";
}

/// Listens at a port, which nobody else then can.
class PortHolder {
 public:
  explicit PortHolder(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const sockaddr_in address = local_address(port);
    holds_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
             ::listen(socket_, 1) == 0;
  }
  ~PortHolder() { ::close(socket_); }
  PortHolder(const PortHolder&) = delete;
  PortHolder& operator=(const PortHolder&) = delete;

  [[nodiscard]] bool holds() const { return holds_; }

 private:
  int socket_;
  bool holds_;
};

class Stranger {
 public:
  explicit Stranger(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const timeval patience{20, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    const sockaddr_in address = local_address(port);
    connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~Stranger() { ::close(socket_); }
  Stranger(const Stranger&) = delete;
  Stranger& operator=(const Stranger&) = delete;

  [[nodiscard]] bool connected() const { return connected_; }

  /// False if the other side does not take it all.
  bool send(const std::string& bytes) const {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t part = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (part <= 0) return false;
      sent += static_cast<std::size_t>(part);
    }
    return true;
  }

  /// Reads on until the other side closes; false if it does not within 20 s after its last word.
  [[nodiscard]] bool is_closed() const {
    char part[4096];
    ssize_t got = 1;
    while (got > 0) got = ::recv(socket_, part, sizeof part, 0);
    return got == 0 || errno == ECONNRESET;
  }

  /// Reads a head of HTTP, and nothing behind it; false if none comes.
  [[nodiscard]] bool gets_head() const {
    std::string head;
    char byte;
    while (head.size() < 4 || head.compare(head.size() - 4, 4, "\r\n\r\n") != 0) {
      if (::recv(socket_, &byte, 1, 0) != 1) return false;
      head += byte;
    }
    return true;
  }

  /// Whether it is closed by now. What was said is not read.
  [[nodiscard]] bool is_closed_now() const {
    char part;
    const ssize_t got = ::recv(socket_, &part, 1, MSG_PEEK | MSG_DONTWAIT);
    return got == 0 || (got < 0 && errno == ECONNRESET);
  }

 private:
  int socket_;
  bool connected_;
};

}  // namespace gvom::test
