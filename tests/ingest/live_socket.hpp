// A socket that sends as a sensor does.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "services/ingest/address.hpp"
#include "tests/ingest/frames_builder.hpp"
#include "tests/ingest/recordings.hpp"

namespace gvom::test {

/// A socket on this machine. `port` is 0 for one that the kernel chooses.
class Socket {
 public:
  explicit Socket(const std::string& own = "127.0.0.1", std::uint16_t port = 0) {
    const auto at = ingest::socket_address(ingest::parse_address(own).value(), port);
    socket_ = ::socket(at.storage.ss_family, SOCK_DGRAM, 0);
    REQUIRE(::bind(socket_, at.get(), at.size) == 0);
    sockaddr_in6 bound{};
    socklen_t size = sizeof bound;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&bound), &size);
    port_ = ntohs(bound.sin6_port);  // where a sockaddr_in has it too
  }
  ~Socket() { ::close(socket_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  [[nodiscard]] int get() const { return socket_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  void send(std::uint16_t to, const ByteVector& payload) const { send("127.0.0.1", to, payload); }
  void send(const std::string& host, std::uint16_t port, const ByteVector& payload) const {
    const auto to = ingest::socket_address(ingest::parse_address(host).value(), port);
    REQUIRE(::sendto(socket_, payload.data(), payload.size(), 0, to.get(), to.size) ==
            static_cast<ssize_t>(payload.size()));
  }

 private:
  int socket_ = -1;
  std::uint16_t port_ = 0;
};

inline std::uint16_t free_port() {
  return Socket().port();
}

/// For a sweep that was sent.
inline constexpr std::chrono::milliseconds kWait(200);

}  // namespace gvom::test
