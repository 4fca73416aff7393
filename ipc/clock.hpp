// The clock of all mono_*_ns, and others as nanoseconds.
#pragma once

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

}  // namespace gvom::ipc
