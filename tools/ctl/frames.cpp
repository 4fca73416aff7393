#include "tools/ctl/frames.hpp"

#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "ipc/runtime.hpp"

namespace gvom::ctl {

namespace {

constexpr std::size_t kLongest = 32768;

struct FrameHead {
  FrameKind kind;
  std::uint32_t reserved;
  std::int64_t mono_ns;
};

}  // namespace

bool send_frame(int socket, FrameKind kind, const void* payload, std::size_t bytes) {
  FrameHead head{kind, 0, ipc::monotonic_ns()};
  iovec parts[2] = {{&head, sizeof head}, {const_cast<void*>(payload), bytes}};
  msghdr message{};
  message.msg_iov = parts;
  message.msg_iovlen = 2;
  if (::sendmsg(socket, &message, MSG_DONTWAIT | MSG_NOSIGNAL) >= 0) return true;
  return errno == EAGAIN || errno == ENOBUFS;
}

bool send_frame(int socket, FrameKind kind, const std::string& text) {
  return send_frame(socket, kind, text.data(), std::min(text.size(), kLongest / 2));
}

Received receive_frame(int socket, Frame& out) {
  std::byte buffer[kLongest];
  const ssize_t size = ::recv(socket, buffer, sizeof buffer, MSG_DONTWAIT);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return Received::nothing;
  if (size < static_cast<ssize_t>(sizeof(FrameHead))) return Received::end;
  FrameHead head;
  std::memcpy(&head, buffer, sizeof head);
  out.kind = head.kind;
  out.mono_ns = head.mono_ns;
  out.payload.assign(buffer + sizeof head, buffer + size);
  return Received::frame;
}

}  // namespace gvom::ctl
