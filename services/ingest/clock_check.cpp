#include "services/ingest/clock_check.hpp"

#include <algorithm>
#include <cstdlib>

namespace gvom::ingest {

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kOldestUnix = 1'000'000'000 * kSecond;   // of 2001
constexpr std::int64_t kLongestUptime = 100'000'000 * kSecond;  // three years
constexpr std::int64_t kNear = kSecond / 2;                     // of a live offset: things come late
constexpr std::int64_t kTogether = 2 * kSecond;                 // begins and ends of one drive's recordings
constexpr std::int64_t kSlack = kSecond * 3 / 10;  // of recordings: odometry need not reach as far

struct Known {
  std::int64_t offset_s;
  const char* words;
};
// Since 2017, when UTC had its last leap second.
constexpr Known kKnown[] = {{37, "that is TAI - UTC"}, {18, "that is GPS - UTC"}, {19, "that is TAI - GPS"}};

const char* guess_boot(std::int64_t lidar_ns, std::int64_t odometry_ns) {
  const auto is_unix = [](std::int64_t time_ns) { return time_ns > kOldestUnix; };
  const auto is_uptime = [](std::int64_t time_ns) { return time_ns >= 0 && time_ns < kLongestUptime; };
  if (is_uptime(lidar_ns) && is_unix(odometry_ns)) return "the lidar's counts from its boot";
  if (is_unix(lidar_ns) && is_uptime(odometry_ns)) return "the odometry's counts from its boot";
  return "";
}

}  // namespace

void ClockCheck::take_odometry(std::int64_t stamp_ns, std::int64_t came_ns) {
  if (came_ns - begin_ns_ >= kSecond) {
    before_ns_ = came_ns - begin_ns_ < 2 * kSecond ? least_delay_ns_ : kNone;
    least_delay_ns_ = kNone;
    begin_ns_ = came_ns;
  }
  least_delay_ns_ = std::min(least_delay_ns_, came_ns - stamp_ns);
}

std::optional<std::int64_t> ClockCheck::ahead_ns(std::int64_t time_ns, std::int64_t received_ns) const {
  const std::int64_t delay_ns = std::min(least_delay_ns_, before_ns_);
  if (delay_ns == kNone) return std::nullopt;
  return time_ns - (received_ns - delay_ns);
}

const char* guess_clock(std::int64_t ahead_ns, std::int64_t lidar_ns, std::int64_t odometry_ns) {
  for (const Known& known : kKnown)
    if (std::llabs(std::llabs(ahead_ns) - known.offset_s * kSecond) < kNear) return known.words;
  return guess_boot(lidar_ns, odometry_ns);
}

const char* guess_clock(const TimeSpan& sweeps, const TimeSpan& odometry) {
  const char* guess = "";
  int fits = 0;
  for (const Known& known : kKnown)
    for (const std::int64_t ahead_ns : {known.offset_s * kSecond, -known.offset_s * kSecond}) {
      if (sweeps.first_ns - ahead_ns < odometry.first_ns - kSlack) continue;
      if (sweeps.last_ns - ahead_ns > odometry.last_ns + kSlack) continue;
      guess = known.words;
      ++fits;
    }
  if (fits > 0) return fits == 1 ? guess : "";
  return guess_boot(sweeps.first_ns, odometry.first_ns);
}

const char* guess_shift(const TimeSpan& sweeps, const TimeSpan& odometry) {
  const std::int64_t begin_ns = sweeps.first_ns - odometry.first_ns;
  const std::int64_t end_ns = sweeps.last_ns - odometry.last_ns;
  const char* guess = "";
  std::int64_t least_ns = 2 * kTogether;
  for (const Known& known : kKnown)
    for (const std::int64_t ahead_ns : {known.offset_s * kSecond, -known.offset_s * kSecond}) {
      const std::int64_t begin_off_ns = std::llabs(begin_ns - ahead_ns);
      const std::int64_t end_off_ns = std::llabs(end_ns - ahead_ns);
      if (std::max(begin_off_ns, end_off_ns) > kTogether || begin_off_ns + end_off_ns >= least_ns) continue;
      least_ns = begin_off_ns + end_off_ns;
      guess = known.words;
    }
  return guess;
}

}  // namespace gvom::ingest
