#include "services/ingest/udp_receiver.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "services/ingest/monotonic.hpp"

namespace gvom::ingest {
namespace {

constexpr std::size_t kMaxDatagram = 65536;

void enlarge_buffer(int socket, std::uint16_t port, SourceState& state) {
  if (::setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &kWantedBuffer, sizeof kWantedBuffer) != 0) {
    ::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &kWantedBuffer, sizeof kWantedBuffer);
  }
  int granted = 0;
  socklen_t size = sizeof granted;
  ::getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &granted, &size);
  if (granted / 2 >= kSufficientBuffer) return;  // the kernel reports the double
  state.warnings.push_back("UDP port " + std::to_string(port) + ": the kernel grants a receive buffer of " +
                           std::to_string(granted / 2048) + " KiB only; raise net.core.rmem_max to " +
                           std::to_string(kWantedBuffer));
}

std::uint32_t dropped_by_kernel(msghdr& message, std::uint32_t before) {
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SO_RXQ_OVFL) continue;
    std::uint32_t count = 0;
    std::memcpy(&count, CMSG_DATA(c), sizeof count);
    return count;
  }
  return before;
}

}  // namespace

UdpReceiver::UdpReceiver(int socket, std::uint16_t port, SourceState& state)
    : socket_(socket), port_(port), state_(state), buffer_(kMaxDatagram) {}

UdpReceiver::~UdpReceiver() {
  ::close(socket_);
}

tl::expected<std::unique_ptr<UdpReceiver>, std::string> UdpReceiver::open(std::uint16_t port,
                                                                          const std::string& bind_address,
                                                                          SourceState& state) {
  sockaddr_in local{};
  local.sin_family = AF_INET;
  local.sin_port = htons(port);
  if (!bind_address.empty() && ::inet_pton(AF_INET, bind_address.c_str(), &local.sin_addr) != 1) {
    return tl::unexpected("bind: '" + bind_address + "' is not an IPv4 address");
  }
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return tl::unexpected(std::string("UDP socket: ") + std::strerror(errno));
  std::unique_ptr<UdpReceiver> receiver(new UdpReceiver(socket, port, state));
  enlarge_buffer(socket, port, state);
  const int on = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&local), sizeof local) != 0) {
    return tl::unexpected("UDP port " + std::to_string(port) +
                          (bind_address.empty() ? "" : " on " + bind_address) + ": " + std::strerror(errno));
  }
  return receiver;
}

tl::expected<PacketEvent, std::string> UdpReceiver::next(Packet& out, std::chrono::milliseconds timeout) {
  auto received = receive(out);
  if (!received || *received == PacketEvent::packet) return received;
  pollfd wait{socket_, POLLIN, 0};
  const int ready = ::poll(&wait, 1, static_cast<int>(std::max<std::int64_t>(0, timeout.count())));
  return ready > 0 ? receive(out) : received;
}

tl::expected<PacketEvent, std::string> UdpReceiver::receive(Packet& out) {
  sockaddr_in sender{};
  iovec space{buffer_.data(), buffer_.size()};
  alignas(cmsghdr) char control[64];
  msghdr message{};
  message.msg_name = &sender;
  message.msg_namelen = sizeof sender;
  message.msg_iov = &space;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const ssize_t size = ::recvmsg(socket_, &message, MSG_DONTWAIT);
  if (size < 0) {
    const bool nothing = errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == ECONNREFUSED;
    if (nothing) return PacketEvent::idle;
    return tl::unexpected("UDP port " + std::to_string(port_) + ": " + std::strerror(errno));
  }
  const std::uint32_t drops = dropped_by_kernel(message, kernel_drops_);
  state_.counters.kernel_drops += drops - kernel_drops_;
  kernel_drops_ = drops;
  out = Packet{};
  out.data = buffer_.data();
  out.size = static_cast<std::size_t>(size);
  out.received_ns = monotonic_ns();
  std::memcpy(out.source.data(), &sender.sin_addr, sizeof sender.sin_addr);
  out.port = port_;
  return PacketEvent::packet;
}

tl::expected<void, std::string> UdpReceiver::rewind() {
  return tl::unexpected("UDP port " + std::to_string(port_) + ": a live source cannot start again");
}

}  // namespace gvom::ingest
