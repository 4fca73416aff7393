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

namespace gvom::ipc {
namespace {

constexpr char kFile[] = "/dev/shm/gvom_doorbell";
constexpr std::size_t kBytes = 4096;  // a page, which no other data shares

tl::unexpected<Error> failed(ErrorKind kind, const std::string& what) {
  return tl::unexpected(Error{kind, std::string(kFile) + ": " + what + ": " + std::strerror(errno)});
}

bool reserve(int fd) {
  errno = ::posix_fallocate(fd, 0, kBytes);  // now, so that no touch of it can fail later
  return errno == 0;
}

timespec to_timespec(std::chrono::steady_clock::time_point time) {
  const auto since = time.time_since_epoch();
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
  return {static_cast<time_t>(seconds.count()),
          static_cast<long>(std::chrono::nanoseconds(since - seconds).count())};
}

}  // namespace

Expected<void> Doorbell::install() {
  if (::unlink(kFile) != 0 && errno != ENOENT) {
    return failed(ErrorKind::denied, "left by another user and cannot be removed");
  }
  const int fd = ::open(kFile, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0660);
  if (fd < 0) return failed(ErrorKind::denied, "cannot be made");
  const bool good = ::fchmod(fd, 0660) == 0 && reserve(fd);  // whatever the umask
  const int why = errno;
  ::close(fd);
  if (good) return {};
  ::unlink(kFile);
  errno = why;
  return failed(ErrorKind::no_space, "cannot reserve a page");
}

void Doorbell::remove() {
  ::unlink(kFile);
}

Expected<std::shared_ptr<Doorbell>> Doorbell::open() {
  const int fd = ::open(kFile, O_RDWR | O_CLOEXEC);
  if (fd < 0) {
    return errno == ENOENT
               ? failed(ErrorKind::unavailable, "the broker is not gvom-roudi, or another version")
               : failed(ErrorKind::denied, "run this process in the broker's group");
  }
  struct stat status {};
  const bool whole = ::fstat(fd, &status) == 0 && status.st_size >= static_cast<off_t>(kBytes);
  void* page = whole ? ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0) : MAP_FAILED;
  ::close(fd);
  if (page == MAP_FAILED) return failed(ErrorKind::unavailable, "cannot be mapped");
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
  return result == 0 || errno != ETIMEDOUT;
}

}  // namespace gvom::ipc
