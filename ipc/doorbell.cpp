#include "ipc/doorbell.hpp"

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstring>
#include <string>
#include <utility>

namespace gvom::ipc {
namespace {

constexpr char kFile[] = "/dev/shm/gvom_doorbell";
constexpr std::size_t kBytes = 4096;  // a page, which no other data shares

/// `what` and, with `error`, the system's word for it.
tl::unexpected<Error> failed(ErrorKind kind, const std::string& what, int error = 0) {
  std::string message = std::string(kFile) + ": " + what;
  if (error != 0) message += std::string(": ") + std::strerror(error);
  return tl::unexpected(Error{kind, std::move(message)});
}

/// A page that whoever is in the group can write, whatever the umask; 0 or errno.
int furnish(int fd) {
  if (::fchmod(fd, 0660) != 0) return errno;
  return ::posix_fallocate(fd, 0, kBytes);  // now, so that no touch of it can fail later
}

/// The page of the bell that `fd` is; MAP_FAILED with errno.
void* map_page(int fd) {
  struct stat status {};
  if (::fstat(fd, &status) != 0) return MAP_FAILED;
  if (status.st_size >= static_cast<off_t>(kBytes))
    return ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  errno = ENODATA;
  return MAP_FAILED;
}

timespec to_timespec(std::chrono::steady_clock::time_point time) {
  const auto since = time.time_since_epoch();
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
  return {static_cast<time_t>(seconds.count()),
          static_cast<long>(std::chrono::nanoseconds(since - seconds).count())};
}

}  // namespace

Expected<void> Doorbell::install() {
  if (::unlink(kFile) != 0 && errno != ENOENT)
    return failed(ErrorKind::denied, "left by another user and cannot be removed", errno);
  const int fd = ::open(kFile, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0660);
  if (fd < 0)
    return failed(errno == EACCES ? ErrorKind::denied : ErrorKind::no_space, "cannot be made", errno);
  const int error = furnish(fd);
  ::close(fd);
  if (error == 0) return {};
  remove();
  return failed(ErrorKind::no_space, "no room for a page", error);
}

void Doorbell::remove() {
  ::unlink(kFile);
}

Expected<std::shared_ptr<Doorbell>> Doorbell::open() {
  const int fd = ::open(kFile, O_RDWR | O_CLOEXEC);
  if (fd < 0 && errno == EACCES)
    return failed(ErrorKind::denied, "not ours to write: run this process in the broker's group");
  if (fd < 0 && errno == ENOENT)
    return failed(ErrorKind::unavailable, "is not there: the broker is just stopping, or is not gvom-roudi");
  if (fd < 0) return failed(ErrorKind::unavailable, "cannot be opened", errno);
  void* const page = map_page(fd);
  const int error = errno;
  ::close(fd);
  if (page == MAP_FAILED) return failed(ErrorKind::unavailable, "cannot be mapped", error);
  return std::shared_ptr<Doorbell>(new Doorbell(static_cast<Word*>(page)));
}

Doorbell::~Doorbell() {
  ::munmap(word_, kBytes);
}

void Doorbell::ring(std::uint32_t sets) {
  word_->fetch_add(1);
  ::syscall(SYS_futex, word_, FUTEX_WAKE_BITSET, INT_MAX, nullptr, nullptr, sets);
}

std::uint32_t Doorbell::rings() const {
  return word_->load();
}

bool Doorbell::wait(std::uint32_t known, std::uint32_t sets,
                    std::chrono::steady_clock::time_point deadline) const {
  const timespec until = to_timespec(deadline);  // CLOCK_MONOTONIC, which steady_clock is on Linux
  const auto result = ::syscall(SYS_futex, word_, FUTEX_WAIT_BITSET, known, &until, nullptr, sets);
  return result == 0 || errno == EAGAIN || errno == EINTR;
}

}  // namespace gvom::ipc
