// How often a device failed in flight, in a file: the process that tells it ends with each failure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace gvom::services {

/// A moment that no step of the wall clock moves, and the boot that it is of.
struct BootMoment {
  std::string boot_id;             ///< "unknown" where the kernel does not tell it (ProcSubset=pid).
  std::int64_t since_boot_ns = 0;  ///< CLOCK_BOOTTIME.

  static BootMoment now();
};

struct DeviceFailure {
  std::int64_t since_boot_ns = 0;
  std::string what;  ///< The driver's words, on one line.
};

inline constexpr std::int64_t kFailuresWithin_ns = 60'000'000'000;

/// No more are kept, and so many within a minute are too many.
inline constexpr std::size_t kTooManyFailures = 3;

/// Where a process on the bus has its record: beside its socket and lock, which live as long, until a reboot.
std::string device_record_of(const std::string& process);

/// Those of the last minute of this boot, the newest last; none if there is no file. Errors, in words: the
/// file is damaged, another user's, or cannot be read.
tl::expected<std::vector<DeviceFailure>, std::string> recent_failures(const std::string& path,
                                                                      const BootMoment& now);

/// Adds one: the file is replaced as a whole. One that cannot be read begins anew. Errors, in words: it
/// cannot be written.
tl::expected<void, std::string> add_failure(const std::string& path, const BootMoment& now,
                                            const std::string& what);

}  // namespace gvom::services
