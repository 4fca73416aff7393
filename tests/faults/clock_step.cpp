// LD_PRELOAD: a wall clock that a test can set forward and back, for this process alone, also while it waits.
// $GVOM_CLOCK_STEP names a file of one int64: seconds that the clock is ahead.
#include <fcntl.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <ctime>

namespace {

constexpr std::int64_t kSlice_ns = 10'000'000;  // how soon a waiting process notices a step
constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::int64_t step_ns() {
  static const std::atomic<std::int64_t>* const step = [] {
    const char* path = std::getenv("GVOM_CLOCK_STEP");
    const int fd = path != nullptr ? ::open(path, O_RDONLY | O_CLOEXEC) : -1;
    void* memory = fd < 0 ? MAP_FAILED : ::mmap(nullptr, sizeof *step, PROT_READ, MAP_SHARED, fd, 0);
    if (memory == MAP_FAILED) std::abort();
    return static_cast<const std::atomic<std::int64_t>*>(memory);
  }();
  return *step * kSecond_ns;
}

std::int64_t real_ns() {
  timespec now{};
  ::syscall(SYS_clock_gettime, CLOCK_REALTIME, &now);
  return now.tv_sec * kSecond_ns + now.tv_nsec;
}

timespec timespec_of(std::int64_t time_ns) {
  return {time_ns / kSecond_ns, time_ns % kSecond_ns};
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* now) noexcept {
  const int result = static_cast<int>(::syscall(SYS_clock_gettime, clock, now));
  if (result == 0 && clock == CLOCK_REALTIME)
    *now = timespec_of(now->tv_sec * kSecond_ns + now->tv_nsec + step_ns());
  return result;
}

extern "C" int sem_timedwait(sem_t* semaphore, const timespec* deadline) {
  const int before = errno;  // on success it stays: iceoryx looks at it
  const std::int64_t deadline_ns = deadline->tv_sec * kSecond_ns + deadline->tv_nsec;
  while (true) {
    const std::int64_t now_ns = real_ns();
    const std::int64_t slice_end_ns = std::min(deadline_ns - step_ns(), now_ns + kSlice_ns);
    const timespec slice = timespec_of(slice_end_ns);
    if (::sem_clockwait(semaphore, CLOCK_REALTIME, &slice) == 0) {
      errno = before;
      return 0;
    }
    if (errno != ETIMEDOUT || real_ns() >= deadline_ns - step_ns()) return -1;
  }
}
