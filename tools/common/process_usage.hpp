// What a process has used so far, from /proc.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace gvom::tools {

struct Usage {
  double cpu_s = 0.0;               ///< User and system time since its start.
  std::uint64_t peak_bytes = 0;     ///< VmHWM: the most it had in memory, touched shared memory included.
  std::uint64_t private_bytes = 0;  ///< RssAnon: now in memory and its own alone.
};

/// utime + stime of the text of /proc/PID/stat, in clock ticks; nothing if the text is not of that form.
std::optional<std::uint64_t> cpu_ticks_of(const std::string& stat);

/// `key` (such as "VmHWM") of the text of /proc/PID/status, bytes; nothing if it is not there.
std::optional<std::uint64_t> memory_bytes_of(const std::string& status, const std::string& key);

/// Nothing if there is no such process (any more).
std::optional<Usage> read_usage(std::uint32_t pid);

}  // namespace gvom::tools
