#include "services/ingest/hour_clock.hpp"

#include <cstdlib>

namespace gvom::ingest {
namespace {

constexpr std::int64_t kHourNs = 3'600'000'000'000;
constexpr std::int64_t kContradictionNs = kHourNs / 4 * 3;

std::int64_t floor_to_hour(std::int64_t time_ns) {
  const std::int64_t past = time_ns % kHourNs;
  return time_ns - (past < 0 ? past + kHourNs : past);
}

/// The time `past_hour_ns` after a full hour that is nearest to `near_ns`.
std::int64_t nearest(std::int64_t past_hour_ns, std::int64_t near_ns) {
  return floor_to_hour(near_ns - past_hour_ns + kHourNs / 2) + past_hour_ns;
}

}  // namespace

std::int64_t HourClock::full_time_ns(std::int64_t past_hour_ns, std::int64_t capture_ns,
                                     std::int64_t received_ns) {
  live_ = received_ns != 0;
  const std::int64_t reference = live_ ? received_ns : capture_ns;
  std::int64_t near = live_ ? hint_.value_or(past_hour_ns) : capture_ns;
  if (last_) near = last_->full_ns + (reference - last_->reference_ns);
  const std::int64_t full = nearest(past_hour_ns, near);
  last_ = Moment{full, reference};
  return full;
}

void HourClock::hint(std::int64_t stamp_ns) {
  const bool contradicts = !last_ || std::llabs(stamp_ns - last_->full_ns) > kContradictionNs;
  hint_ = stamp_ns;
  if (contradicts && live_) last_.reset();
}

}  // namespace gvom::ingest
