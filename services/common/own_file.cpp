#include "services/common/own_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace gvom::services {
namespace {

using Failed = tl::unexpected<std::string>;

constexpr std::size_t kLargestFile = 4096;  // bytes

Failed failed(const std::string& path, int error) {
  return Failed(path + ": " + std::strerror(error));
}

}  // namespace

tl::expected<std::optional<std::string>, std::string> read_own(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0 && errno == ENOENT) return std::nullopt;
  if (file < 0) return failed(path, errno);
  struct stat status {};
  const bool own = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == ::geteuid();
  std::string text(kLargestFile, '\0');
  const ssize_t got = own ? ::read(file, text.data(), text.size()) : 0;
  const int error = errno;
  ::close(file);
  if (!own) return Failed(path + ": not a file of this user");
  if (got < 0) return failed(path, error);
  text.resize(static_cast<std::size_t>(got));
  return text;
}

tl::expected<void, std::string> replace_own(const std::string& path, const std::string& text) {
  std::string fresh = path + ".XXXXXX";
  const int file = ::mkstemp(fresh.data());
  if (file < 0) return failed(path, errno);
  errno = ENOSPC;  // a short write's reason
  const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (written && ::close(file) == 0 && ::rename(fresh.c_str(), path.c_str()) == 0) return {};
  const int error = errno;
  if (!written) ::close(file);
  ::unlink(fresh.c_str());
  return failed(path, error);
}

std::string boot_id() {
  std::string id;
  return std::ifstream("/proc/sys/kernel/random/boot_id") >> id ? id : "unknown";
}

}  // namespace gvom::services
