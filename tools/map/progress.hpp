// How far a long run is, for a person at a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "core/time_span.hpp"

namespace gvom::tools {

/// "42 %: 118 of 280 s, 1180 sweeps mapped, 3.1 times real time". `span`: of the odometry; without it only
/// what was done is known. `done`: stamps of the first sweep and the newest; `took_s`: since the start.
std::string progress_text(const std::optional<TimeSpan>& span, TimeSpan done, int sweeps, double took_s);

/// One line on stderr that is written over, five times a second at most; silent if that is no terminal.
class Progress {
 public:
  explicit Progress(const std::optional<TimeSpan>& span);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void mapped(std::int64_t stamp_ns);
  /// Makes room for a line of the log.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<TimeSpan> span_;
  bool is_terminal_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_{};
  std::optional<std::int64_t> first_ns_;
  int sweeps_ = 0;
  bool shown_ = false;
};

}  // namespace gvom::tools
