#include "services/ingest/udp_receiver.hpp"

#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "ipc/clock.hpp"

namespace gvom::ingest {
namespace {

constexpr std::size_t kMaxDatagram = 65536;

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

}  // namespace

UdpReceiver::UdpReceiver(int socket, UdpOptions options, SourceState& state)
    : socket_(socket),
      options_(std::move(options)),
      interface_(::if_nametoindex(options_.interface.c_str())),
      state_(state),
      buffer_(kMaxDatagram),
      not_before_ns_(ipc::monotonic_ns()) {}

UdpReceiver::~UdpReceiver() {
  ::close(socket_);
}

tl::expected<std::unique_ptr<UdpReceiver>, SourceError> UdpReceiver::open(const UdpOptions& options,
                                                                          SourceState& state) {
  UdpOptions joined = options;  // by name, so that its loss is seen
  if (options.group && options.interface.empty()) joined.interface = interface_towards(*options.group);
  const auto socket = open_udp_socket(joined, state.warnings);
  if (!socket) return tl::unexpected(socket.error());
  return std::unique_ptr<UdpReceiver>(new UdpReceiver(*socket, joined, state));
}

/// An interface that was taken away and came back is another one, of which nothing is joined.
bool UdpReceiver::interface_is_gone() const {
  return !options_.interface.empty() && ::if_nametoindex(options_.interface.c_str()) != interface_;
}

tl::expected<PacketEvent, std::string> UdpReceiver::next(Packet& out, std::chrono::milliseconds timeout) {
  auto received = receive(out);
  if (!received || *received == PacketEvent::packet) return received;
  pollfd wait{socket_, POLLIN, 0};
  const int ready = ::poll(&wait, 1, static_cast<int>(std::max<std::int64_t>(0, timeout.count())));
  if (ready > 0) return receive(out);
  if (timeout.count() > 0 && interface_is_gone())
    return tl::unexpected(to_text(options_) + ": the interface is gone");
  return received;
}

tl::expected<PacketEvent, std::string> UdpReceiver::receive(Packet& out) {
  sockaddr_storage sender{};
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
    if (errno == EAGAIN || errno == EWOULDBLOCK) {
      not_before_ns_ = asked_ns;
      suspended_ns_ = ipc::suspended_ns();
    }
    if (nothing) return PacketEvent::idle;
    return tl::unexpected(to_text(options_) + ": " + std::strerror(errno));
  }
  const Beside beside = read_beside(message, kernel_drops_);
  state_.counters.kernel_drops += beside.drops - kernel_drops_;
  kernel_drops_ = beside.drops;
  out = Packet{};
  out.data = buffer_.data();
  out.size = static_cast<std::size_t>(size);
  out.capture_ns = beside.arrived_ns;
  out.received_ns = received_at(beside.arrived_ns);
  out.suspended_ns = suspended_ns_;
  out.source = address_of(sender);
  out.port = options_.port;
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
  return tl::unexpected(to_text(options_) + ": a live source cannot start again");
}

}  // namespace gvom::ingest
