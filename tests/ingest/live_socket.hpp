// A socket that sends as a sensor does.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "services/ingest/address.hpp"
#include "tests/ingest/frames_builder.hpp"
#include "tests/ingest/ouster_builder.hpp"
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

/// Reads on until the source has had `packets` packets in all: a call ends early where this machine stands
/// still. Whether the last one closed a sweep.
inline bool read_to(ingest::Source& source, Sweep& sweep, std::uint64_t packets) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  bool closed = false;
  do {
    const auto event = source.next(sweep, std::chrono::milliseconds(20));
    REQUIRE(event.has_value());
    closed = *event == ingest::SourceEvent::kSweep;
  } while (source.counters().packets < packets && std::chrono::steady_clock::now() < end);
  REQUIRE(source.counters().packets >= packets);
  return closed;
}

/// Sends frames until one is a sweep, and returns its number; 0 if none is. Where this machine stands still
/// while the first is sent, its sender has not yet had a sensor's rate.
inline int first_sweep(ingest::Source& source, Sweep& sweep, const Socket& sender, const std::string& host,
                       std::uint16_t port, const OusterSensor& sensor = {}) {
  for (int frame = 1; frame <= 20; ++frame) {
    const std::uint64_t before = source.counters().packets;
    for (int column = 0; column < 16; column += 4)
      sender.send(host, port, plain_packet(sensor, frame, column));
    if (read_to(source, sweep, before + 4) && sweep.complete) return frame;
  }
  return 0;
}

}  // namespace gvom::test
