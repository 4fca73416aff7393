#include "services/ingest/udp_receiver.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "ipc/clock.hpp"

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

/// What the kernel says beside a packet.
struct Beside {
  std::uint32_t drops;          // before it, since the socket was opened
  std::int64_t arrived_ns = 0;  // Unix time
};

Beside read_beside(msghdr& message, std::uint32_t drops_before) {
  Beside beside{drops_before};
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SO_RXQ_OVFL) std::memcpy(&beside.drops, CMSG_DATA(c), sizeof beside.drops);
    if (c->cmsg_type != SO_TIMESTAMPNS) continue;
    timespec time{};
    std::memcpy(&time, CMSG_DATA(c), sizeof time);
    beside.arrived_ns = ipc::to_ns(time);
  }
  return beside;
}

/// Why a port cannot be had. What another process or a network has not yet made ready may be there later.
SourceError bind_error(const std::string& what) {
  const auto kind = errno == EACCES ? SourceError::Kind::bad_data : SourceError::Kind::unavailable;
  return {what + ": " + std::strerror(errno), kind};
}

}  // namespace

UdpReceiver::UdpReceiver(int socket, std::uint16_t port, SourceState& state)
    : socket_(socket),
      port_(port),
      state_(state),
      buffer_(kMaxDatagram),
      not_before_ns_(ipc::monotonic_ns()) {}

UdpReceiver::~UdpReceiver() {
  ::close(socket_);
}

tl::expected<std::unique_ptr<UdpReceiver>, SourceError> UdpReceiver::open(std::uint16_t port,
                                                                          const std::string& bind_address,
                                                                          SourceState& state) {
  sockaddr_in local{};
  local.sin_family = AF_INET;
  local.sin_port = htons(port);
  if (!bind_address.empty() && ::inet_pton(AF_INET, bind_address.c_str(), &local.sin_addr) != 1) {
    return tl::unexpected("bind: '" + bind_address + "' is not an IPv4 address");
  }
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return tl::unexpected(bind_error("UDP socket"));
  std::unique_ptr<UdpReceiver> receiver(new UdpReceiver(socket, port, state));
  enlarge_buffer(socket, port, state);
  const int on = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
  ::setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&local), sizeof local) != 0) {
    return tl::unexpected(
        bind_error("UDP port " + std::to_string(port) + (bind_address.empty() ? "" : " on " + bind_address)));
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
  alignas(cmsghdr) char control[128];
  msghdr message{};
  message.msg_name = &sender;
  message.msg_namelen = sizeof sender;
  message.msg_iov = &space;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const std::int64_t asked_ns = ipc::monotonic_ns();
  const ssize_t size = ::recvmsg(socket_, &message, MSG_DONTWAIT);
  if (size < 0) {
    const bool nothing = errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == ECONNREFUSED;
    if (errno == EAGAIN || errno == EWOULDBLOCK) not_before_ns_ = asked_ns;
    if (nothing) return PacketEvent::idle;
    return tl::unexpected("UDP port " + std::to_string(port_) + ": " + std::strerror(errno));
  }
  const Beside beside = read_beside(message, kernel_drops_);
  state_.counters.kernel_drops += beside.drops - kernel_drops_;
  kernel_drops_ = beside.drops;
  out = Packet{};
  out.data = buffer_.data();
  out.size = static_cast<std::size_t>(size);
  out.capture_ns = beside.arrived_ns;
  out.received_ns = received_at(beside.arrived_ns);
  std::memcpy(out.source.data(), &sender.sin_addr, sizeof sender.sin_addr);
  out.port = port_;
  return PacketEvent::packet;
}

/// The wall clock may have been set while the packet waited: it came after the one before it, after the queue
/// was last empty, and not later than now.
std::int64_t UdpReceiver::received_at(std::int64_t arrived_ns) {
  const std::int64_t now_ns = ipc::monotonic_ns();
  const std::int64_t waited_ns = arrived_ns == 0 ? 0 : ipc::clock_ns(CLOCK_REALTIME) - arrived_ns;
  not_before_ns_ = std::clamp(now_ns - waited_ns, not_before_ns_, now_ns);
  return not_before_ns_;
}

tl::expected<void, std::string> UdpReceiver::rewind() {
  return tl::unexpected("UDP port " + std::to_string(port_) + ": a live source cannot start again");
}

}  // namespace gvom::ingest
