// Bytes of a client to the bridge's server, over a real socket. First byte: 0: as they are; 1: websocket
// frames, behind a handshake. Afterwards nothing of the client may be left.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "services/bridge/foxglove_server.hpp"
#include "tests/fuzz/input.hpp"

using namespace gvom;
using namespace gvom::fuzz;

namespace {

const std::string kHandshake =
    "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
    "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n\r\n";

template <typename Done>
bool eventually(Done done) {
  for (int i = 0; i < 50'000; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  return false;
}

bridge::FoxgloveServer& server() {
  static const auto started = [] {
    bridge::FoxgloveOptions options;
    options.port = 0;
    auto server = bridge::FoxgloveServer::start(std::move(options));
    require(server && eventually([&] { return (*server)->port() != 0; }), "the server listens");
    return std::move(*server);
  }();
  return *started;
}

bool send_all(int socket, const std::uint8_t* data, std::size_t size) {
  while (size > 0) {
    const ssize_t sent = ::send(socket, data, size, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    data += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

/// As recv(); libFuzzer's clock interrupts.
ssize_t receive(int socket, char* into, std::size_t size) {
  while (true) {
    const ssize_t got = ::recv(socket, into, size, 0);
    if (got >= 0 || errno != EINTR) return got;
  }
}

/// Whether the server answers the handshake.
bool is_upgraded(int socket) {
  send_all(socket, reinterpret_cast<const std::uint8_t*>(kHandshake.data()), kHandshake.size());
  std::string head;
  char byte;
  while (head.size() < 4 || head.compare(head.size() - 4, 4, "\r\n\r\n") != 0) {
    if (receive(socket, &byte, 1) != 1) return false;
    head += byte;
  }
  return head.rfind("HTTP/1.1 101", 0) == 0;
}

sockaddr_in loopback(std::uint32_t host, std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl((IN_LOOPBACKNET << 24) + host);
  return address;
}

/// A connection to the server, each from another address: the kernel remembers ports for a minute.
int connected() {
  static std::uint32_t host = 0;
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const timeval patience{5, 0};
  ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  const sockaddr_in from = loopback(host++ % 0xfffff0 + 1, 0), to = loopback(1, server().port());
  require(::bind(socket, reinterpret_cast<const sockaddr*>(&from), sizeof from) == 0,
          "an address of its own");
  require(::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0,
          "the server takes clients");
  return socket;
}

/// Sends all of it, and reads until the server closes.
void visit(bool upgraded, ingest::Bytes bytes) {
  const int socket = connected();
  require(!upgraded || is_upgraded(socket), "a client gets in");
  send_all(socket, bytes.data, bytes.size);
  server().offer(bridge::topic(bridge::TopicId::costmap), 1, std::make_shared<std::vector<std::uint8_t>>(9));
  ::shutdown(socket, SHUT_WR);
  char part[4096];
  ssize_t got = 1;
  while (got > 0) got = receive(socket, part, sizeof part);
  require(got == 0 || errno != EAGAIN, "the server closes when the client has");
  ::close(socket);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  visit(input.byte() % 2 == 1, input.rest());
  require(eventually([] { return server().counters().clients == 0; }), "a client that left is gone");
  for (const bridge::Topic& topic : bridge::kTopics)
    require(!server().wants(topic), "nobody wants what only a client that left wanted");
  return 0;
}
