#include "tools/endurance/channel.hpp"

#include <sys/socket.h>
#include <sys/uio.h>

#include <cerrno>

namespace gvom::endurance {

namespace {

constexpr std::size_t kLongest = 32768;

}  // namespace

bool send_note(int socket, NoteKind kind, const void* payload, std::size_t bytes) {
  iovec parts[2] = {{&kind, sizeof kind}, {const_cast<void*>(payload), bytes}};
  msghdr message{};
  message.msg_iov = parts;
  message.msg_iovlen = 2;
  while (::sendmsg(socket, &message, MSG_NOSIGNAL) < 0)
    if (errno != EINTR) return false;
  return true;
}

Received receive_note(int socket, Note& out) {
  std::byte buffer[kLongest];
  const ssize_t size = ::recv(socket, buffer, sizeof buffer, MSG_DONTWAIT);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return Received::nothing;
  if (size < static_cast<ssize_t>(sizeof(NoteKind))) return Received::end;
  std::memcpy(&out.kind, buffer, sizeof out.kind);
  out.payload.assign(buffer + sizeof out.kind, buffer + size);
  return Received::note;
}

}  // namespace gvom::endurance
