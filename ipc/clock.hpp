// The clock of all mono_*_ns, and others as nanoseconds.
#pragma once

#include <algorithm>
#include <cstdint>
#include <ctime>

namespace gvom::ipc {

inline std::int64_t to_ns(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

inline std::int64_t clock_ns(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return to_ns(now);
}

/// CLOCK_MONOTONIC.
inline std::int64_t monotonic_ns() {
  return clock_ns(CLOCK_MONOTONIC);
}

/// How long the machine was suspended since its start, in whole milliseconds: CLOCK_MONOTONIC stands still
/// then.
inline std::int64_t suspended_ns() {
  std::int64_t most_ns = 0;  // each look says at most the truth: this thread may pause within it
  for (int look = 0; look < 3; ++look) {
    const std::int64_t boot_ns = clock_ns(CLOCK_BOOTTIME);
    most_ns = std::max(most_ns, boot_ns - clock_ns(CLOCK_MONOTONIC));
  }
  return (most_ns + 500'000) / 1'000'000 * 1'000'000;
}

}  // namespace gvom::ipc
