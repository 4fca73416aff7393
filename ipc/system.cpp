#include "ipc/system.hpp"

#include <fcntl.h>
#include <grp.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "ipc/runtime.hpp"

namespace gvom::ipc {
namespace {

Expected<void> check_owner(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || status.st_uid == ::geteuid()) return {};
  return tl::unexpected(Error{ErrorKind::denied, path + " belongs to user " + std::to_string(status.st_uid) +
                                                     ", this process runs as " + std::to_string(::geteuid()) +
                                                     ": run all processes as one user, or remove it"});
}

bool is_locked(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool locked = ::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(fd);
  return locked;
}

}  // namespace

Expected<std::string> group_name() {
  const ::group* group = ::getgrgid(::getegid());
  if (group != nullptr) return std::string(group->gr_name);
  return tl::unexpected(Error{
      ErrorKind::denied,
      "group " + std::to_string(::getegid()) + " of this process has no name, shared memory needs one"});
}

Expected<void> check_name_is_free(const std::string& name) {
  const std::string lock = "/tmp/" + name + ".lock";
  for (const std::string& path : {lock, "/tmp/" + name}) {
    if (auto mine = check_owner(path); !mine) return mine;
  }
  if (!is_locked(lock)) return {};
  return tl::unexpected(
      Error{ErrorKind::in_use, "a living process is '" + name + "' already (" + lock + " is locked)"});
}

std::uint64_t management_inode() {
  struct stat status {};
  return ::stat(kManagementFile, &status) == 0 ? status.st_ino : 0;
}

bool broker_answers() {
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return false;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, kBrokerSocket, sizeof(address.sun_path) - 1);
  const bool connected = ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  ::close(fd);
  return connected;
}

}  // namespace gvom::ipc
