// Logging to stderr with spdlog's own functions (spdlog::info, warn, error), set up once.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

namespace gvom::services {

/// Call once in main. Where stderr is the journal (JOURNAL_STREAM names it), lines carry a priority prefix
/// and no time of their own; elsewhere time, process name and level.
void init_logging(const std::string& process_name);

/// At most one line each `period`; a line that comes after others were held back says how many.
/// For one call site, or for all that mean the same; not for several threads.
class LogEvery {
 public:
  explicit LogEvery(std::chrono::nanoseconds period) : period_(period) {}

  template <typename... Args>
  void operator()(spdlog::level::level_enum level, fmt::format_string<Args...> format, Args&&... args) {
    if (!take_turn()) return;
    if (held_back_ == 0) {
      spdlog::log(level, format, std::forward<Args>(args)...);
    } else {
      spdlog::log(level, "{} ({} more like this)", fmt::format(format, std::forward<Args>(args)...),
                  held_back_);
    }
    held_back_ = 0;
  }

 private:
  bool take_turn();

  std::chrono::nanoseconds period_;
  std::chrono::steady_clock::time_point next_{};
  std::uint64_t held_back_ = 0;
};

}  // namespace gvom::services
