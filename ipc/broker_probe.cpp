#include "ipc/broker_probe.hpp"

#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include "iceoryx_posh/iceoryx_posh_types.hpp"
#include "iceoryx_posh/internal/runtime/ipc_interface_base.hpp"
#include "ipc/system.hpp"

namespace gvom::ipc {
namespace {

constexpr int kMessages = 2;
constexpr std::chrono::milliseconds kLookAgain{2};

/// A sign of life of a process that the broker does not know: it passes over that.
std::string message_without_effect() {
  iox::runtime::IpcMessage message;
  message << iox::runtime::IpcMessageTypeToString(iox::runtime::IpcMessageType::KEEPALIVE) << "gvom-probe";
  return message.getMessage();
}

int connect_to_broker() {
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, kBrokerSocket, sizeof(address.sun_path) - 1);
  if (fd >= 0 && ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) return fd;
  if (fd >= 0) ::close(fd);
  return -1;
}

bool all_was_read(int fd) {
  int unread_bytes = 0;
  return ::ioctl(fd, SIOCOUTQ, &unread_bytes) == 0 && unread_bytes == 0;
}

bool works(int fd, std::chrono::milliseconds patience) {
  const std::string message = message_without_effect();
  const auto deadline = std::chrono::steady_clock::now() + patience;
  for (int sent = 0; std::chrono::steady_clock::now() < deadline;) {
    if (sent == kMessages && all_was_read(fd)) return true;
    if (sent < kMessages) {
      const bool went = ::send(fd, message.c_str(), message.size() + 1, MSG_NOSIGNAL) >= 0;
      if (!went && errno != EAGAIN && errno != ENOBUFS) return false;  // full: it did not read for long
      sent += went ? 1 : 0;
      if (went) continue;
    }
    std::this_thread::sleep_for(kLookAgain);
  }
  return false;
}

}  // namespace

bool broker_works(std::chrono::milliseconds patience) {
  const int fd = connect_to_broker();
  if (fd < 0) return false;
  const bool result = works(fd, patience);
  ::close(fd);
  return result;
}

std::optional<pid_t> broker_pid() {
  struct stat lock {};
  const std::string path = std::string("/tmp/") + iox::roudi::ROUDI_LOCK_NAME + ".lock";
  if (::stat(path.c_str(), &lock) != 0) return std::nullopt;
  const std::string inode = ":" + std::to_string(lock.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {  // "1: FLOCK  ADVISORY  WRITE 1234 08:01:5678 0 EOF"
    std::istringstream fields(line);
    std::string number, kind, force, access, place;
    pid_t pid = 0;
    if (!(fields >> number >> kind >> force >> access >> pid >> place) || kind != "FLOCK") continue;
    if (place.size() > inode.size() &&
        place.compare(place.size() - inode.size(), std::string::npos, inode) == 0)
      return pid;
  }
  return std::nullopt;
}

std::optional<BrokerOwner> broker_owner() {
  struct stat memory {};
  if (::stat(kManagementFile, &memory) != 0) return std::nullopt;
  return BrokerOwner{memory.st_uid, memory.st_gid};
}

}  // namespace gvom::ipc
