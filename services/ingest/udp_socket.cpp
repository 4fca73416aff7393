#include "services/ingest/udp_socket.hpp"

#include <ifaddrs.h>
#include <net/if.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

namespace gvom::ingest {
namespace {

using Kind = SourceError::Kind;
using Done = tl::expected<void, SourceError>;

/// The address of one option; an interface behind '%' becomes that of the options.
Done read_address(const services::SourceUri& uri, const char* key, std::optional<Address>& out,
                  UdpOptions& options) {
  const auto text = uri.option(key);
  if (!text) return {};
  const auto percent = text->find('%');
  out = parse_address(text->substr(0, percent));
  const std::string where = "source '" + uri.text + "': " + key + ": '" + *text + "' ";
  if (!out) return tl::unexpected(where + "is not an IPv4 or IPv6 address");
  if (percent == std::string::npos) return {};
  const std::string interface = text->substr(percent + 1);
  if (!options.interface.empty() && options.interface != interface)
    return tl::unexpected(where + "is of another interface than " + options.interface);
  options.interface = interface;
  return {};
}

Done check(const services::SourceUri& uri, const UdpOptions& options) {
  const auto wrong = [&](const char* key, const Address& address, const std::string& why) {
    return tl::unexpected<SourceError>("source '" + uri.text + "': " + key + ": '" + to_text(address).data() +
                                       "' " + why);
  };
  if (options.group && !is_multicast(*options.group))
    return wrong("group", *options.group, "is no multicast group (224.0.0.0 .. 239.255.255.255, ff00::/8)");
  if (options.group && options.bind)
    return wrong("bind", *options.bind, "and a group exclude each other: interface=NAME says where to join");
  if (options.bind && is_multicast(*options.bind))
    return wrong("bind", *options.bind, "is a multicast group: group=ADDRESS joins it");
  return {};
}

/// Closes the socket, unless it is released.
class Socket {
 public:
  explicit Socket(int fd) : fd_(fd) {}
  ~Socket() {
    if (fd_ >= 0) ::close(fd_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  [[nodiscard]] int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }
  template <typename T>
  bool set(int level, int option, const T& value) const {
    return ::setsockopt(fd_, level, option, &value, sizeof value) == 0;
  }

 private:
  int fd_;
};

void enlarge_buffer(const Socket& socket, std::uint16_t port, std::vector<std::string>& warnings) {
  if (!socket.set(SOL_SOCKET, SO_RCVBUFFORCE, kWantedBuffer))
    socket.set(SOL_SOCKET, SO_RCVBUF, kWantedBuffer);
  int granted = 0;
  socklen_t size = sizeof granted;
  ::getsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &granted, &size);
  if (granted / 2 >= kSufficientBuffer) return;  // the kernel reports the double
  warnings.push_back("UDP port " + std::to_string(port) + ": the kernel grants a receive buffer of " +
                     std::to_string(granted / 2048) + " KiB only; raise net.core.rmem_max to " +
                     std::to_string(kWantedBuffer));
}

/// What another process holds or a network has not made ready may be there later; permission will not.
SourceError failed(const UdpOptions& options, const std::string& what) {
  const int error = errno;
  return {to_text(options) + ": " + what + std::strerror(error),
          error == EACCES || error == EPERM ? Kind::bad_data : Kind::unavailable};
}

/// The interface that has this address of this machine.
std::string interface_of(const Address& own) {
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(first, ::freeifaddrs);
  for (const ifaddrs* one = first; one != nullptr; one = one->ifa_next) {
    const sockaddr* const at = one->ifa_addr;
    if (at == nullptr || (at->sa_family != AF_INET && at->sa_family != AF_INET6)) continue;
    sockaddr_storage copy{};
    std::memcpy(&copy, at, at->sa_family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6));
    if (address_of(copy) == own) return one->ifa_name;
  }
  return {};
}

/// Packets of the group to this port from that interface only, whatever others have joined.
Done join(const Socket& socket, const UdpOptions& options, unsigned interface) {
  group_req request{};
  request.gr_interface = interface;
  const SocketAddress group = socket_address(*options.group, 0);
  request.gr_group = group.storage;
  const bool ipv4 = is_ipv4(*options.group);
  const int level = ipv4 ? IPPROTO_IP : IPPROTO_IPV6;
  socket.set(level, ipv4 ? IP_MULTICAST_ALL : IPV6_MULTICAST_ALL, 0);
  if (socket.set(level, MCAST_JOIN_GROUP, request)) return {};
  const bool no_route = errno == ENODEV && interface == 0;
  SourceError error = failed(options, "the group cannot be joined: ");
  if (no_route) error.what += "; no route leads to it: say interface=NAME";
  if (errno == ENOBUFS) error.what += "; see net.ipv4.igmp_max_memberships";
  return tl::unexpected(error);
}

/// IPv6 takes IPv4 too, where there is IPv6.
int make_socket(const UdpOptions& options) {
  const auto& own = options.group ? options.group : options.bind;
  const bool ipv4 = own && is_ipv4(*own);
  const int type = SOCK_DGRAM | SOCK_CLOEXEC;
  const int socket = ipv4 ? -1 : ::socket(AF_INET6, type, 0);
  if (socket >= 0 || (own && !ipv4)) return socket;
  return ::socket(AF_INET, type, 0);
}

Done bind(const Socket& socket, const UdpOptions& options, unsigned interface) {
  sockaddr_storage made{};
  socklen_t size = sizeof made;
  ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&made), &size);  // of which family it is
  Address own = made.ss_family == AF_INET ? ipv4_address(std::array<std::uint8_t, 4>{}.data()) : Address{};
  if (options.bind) own = *options.bind;
  if (options.group) own = *options.group;  // and so nothing that is sent to another address
  const SocketAddress address = socket_address(own, options.port, interface);
  if (::bind(socket.get(), address.get(), address.size) == 0) return {};
  return tl::unexpected(failed(options, ""));
}

}  // namespace

tl::expected<UdpOptions, SourceError> udp_options(const services::SourceUri& uri) {
  UdpOptions options;
  const auto port = services::parse_port(uri.path);
  if (!port) return tl::unexpected<SourceError>("source '" + uri.text + "': " + port.error());
  options.port = *port;
  options.interface = uri.option("interface").value_or("");
  Done read = read_address(uri, "bind", options.bind, options);
  if (read) read = read_address(uri, "group", options.group, options);
  if (read) read = check(uri, options);
  if (!read) return tl::unexpected(read.error());
  return options;
}

tl::expected<std::optional<Address>, SourceError> from_option(const services::SourceUri& uri) {
  std::optional<Address> from;
  UdpOptions unused;
  const Done read = read_address(uri, "from", from, unused);
  if (!read) return tl::unexpected(read.error());
  if (from && is_multicast(*from))
    return tl::unexpected<SourceError>("source '" + uri.text + "': from: '" + to_text(*from).data() +
                                       "' is a multicast group, which sends nothing");
  return from;
}

tl::expected<int, SourceError> open_udp_socket(const UdpOptions& options,
                                               std::vector<std::string>& warnings) {
  Socket socket(make_socket(options));
  if (socket.get() < 0) return tl::unexpected(failed(options, "no socket: "));
  unsigned interface = 0;
  if (!options.interface.empty()) interface = ::if_nametoindex(options.interface.c_str());
  if (!options.interface.empty() && interface == 0)
    return tl::unexpected(failed(options, "no such interface: "));
  socket.set(IPPROTO_IPV6, IPV6_V6ONLY, 0);
  enlarge_buffer(socket, options.port, warnings);
  socket.set(SOL_SOCKET, SO_RXQ_OVFL, 1);
  socket.set(SOL_SOCKET, SO_TIMESTAMPNS, 1);
  if (options.group) socket.set(SOL_SOCKET, SO_REUSEADDR, 1);  // a recorder may listen too
  const std::string& name = options.interface;
  if (interface != 0 && !options.group &&
      ::setsockopt(socket.get(), SOL_SOCKET, SO_BINDTODEVICE, name.data(),
                   static_cast<socklen_t>(name.size())) != 0)
    return tl::unexpected(failed(options, "the interface cannot be had: "));
  Done done = bind(socket, options, interface);
  if (done && options.group) done = join(socket, options, interface);
  if (!done) return tl::unexpected(done.error());
  return socket.release();
}

/// Asks a socket's own address on its way there; nothing is sent.
std::string interface_towards(const Address& group) {
  const Socket socket(::socket(is_ipv4(group) ? AF_INET : AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const SocketAddress there = socket_address(group, 9);
  sockaddr_storage own{};
  socklen_t size = sizeof own;
  if (::connect(socket.get(), there.get(), there.size) != 0 ||
      ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&own), &size) != 0)
    return {};
  return interface_of(address_of(own));
}

std::string to_text(const UdpOptions& options) {
  std::string text = "UDP port " + std::to_string(options.port);
  if (options.group) text += std::string(" of group ") + to_text(*options.group).data();
  if (options.bind) text += std::string(" on ") + to_text(*options.bind).data();
  if (!options.interface.empty()) text += " on " + options.interface;
  return text;
}

}  // namespace gvom::ingest
