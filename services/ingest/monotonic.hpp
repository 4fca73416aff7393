// The clocks of `received_ns` and `capture_ns`.
#pragma once

#include <cstdint>
#include <ctime>

namespace gvom::ingest {

inline std::int64_t to_ns(const timespec& time) {
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

/// CLOCK_MONOTONIC, nanoseconds.
inline std::int64_t monotonic_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return to_ns(now);
}

/// CLOCK_REALTIME, nanoseconds: only to say how long ago the kernel's stamps were.
inline std::int64_t wall_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return to_ns(now);
}

}  // namespace gvom::ingest
