// What /proc tells of a process.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>

namespace gvom::endurance {

struct ProcessSample {
  std::uint64_t private_bytes;  ///< RssAnon
  std::uint64_t locked_bytes;   ///< VmLck
  std::uint64_t descriptors;
  std::uint64_t threads;
  std::uint64_t minor_faults;  ///< This and what follows: since its start.
  std::uint64_t major_faults;
  std::uint64_t voluntary_switches;  ///< Of all its threads.
  std::uint64_t involuntary_switches;
  double cpu_s;
};

/// Nothing if there is no such process (any more), or it may not be looked at.
std::optional<ProcessSample> sample_process(pid_t pid);

}  // namespace gvom::endurance
