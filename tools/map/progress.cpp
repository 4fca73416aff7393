#include "tools/map/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace gvom::tools {
namespace {

constexpr std::chrono::milliseconds kEvery{200};

double seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

}  // namespace

std::string progress_text(const std::optional<TimeSpan>& span, TimeSpan done, int sweeps, double took_s) {
  const double done_s = seconds(done.first_ns, done.last_ns);
  const std::string pace = took_s > 0 ? fmt::format(", {:.1f} times real time", done_s / took_s) : "";
  const double all_s = span ? seconds(span->first_ns, span->last_ns) : 0;
  if (all_s <= 0) return fmt::format("{:.0f} s, {} sweeps mapped{}", done_s, sweeps, pace);
  const double through_s = std::clamp(seconds(span->first_ns, done.last_ns), 0.0, all_s);
  return fmt::format("{:.0f} %: {:.0f} of {:.0f} s, {} sweeps mapped{}", 100 * through_s / all_s, through_s,
                     all_s, sweeps, pace);
}

Progress::Progress(const std::optional<TimeSpan>& span)
    : span_(span), is_terminal_(::isatty(STDERR_FILENO) == 1) {}

void Progress::mapped(std::int64_t stamp_ns) {
  ++sweeps_;
  if (!first_ns_) first_ns_ = stamp_ns;
  const auto now = Clock::now();
  if (!is_terminal_ || now < next_) return;
  next_ = now + kEvery;
  const double took_s = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r\x1B[K%s", progress_text(span_, {*first_ns_, stamp_ns}, sweeps_, took_s).c_str());
  std::fflush(stderr);
  shown_ = true;
}

void Progress::clear() {
  if (shown_) std::fputs("\r\x1B[K", stderr);
  shown_ = false;
}

}  // namespace gvom::tools
