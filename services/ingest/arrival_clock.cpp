#include "services/ingest/arrival_clock.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::ingest {

namespace {

constexpr std::int64_t kBack_ns = 50'000'000;  // more than packets change places
constexpr std::int64_t kFarLate_ns = 500'000'000;
constexpr std::int64_t kLateFor_ns = 2'000'000'000;
constexpr double kMostDrift = 200e-6;                      // of a crystal
constexpr std::int64_t kLeastForSlope_ns = 5'000'000'000;  // before, delays tell more than the rate

}  // namespace

void ArrivalClock::take(std::int64_t stamp_ns, std::int64_t arrival_ns) {
  const Pair pair{stamp_ns, arrival_ns - stamp_ns};
  if (count_ == 0) return begin(pair);
  if (!fits(pair)) {
    if (!other_clock_.misfits()) return;
    ++restarts_;
    return begin(pair);
  }
  other_clock_.fits();
  add(pair);
  fit();
}

/// Whether the pair is of the clock that the line is of.
bool ArrivalClock::fits(const Pair& pair) {
  const std::int64_t late_ns = pair.delay_ns - delay_at(pair.stamp_ns);
  if (pair.stamp_ns < newest_ns_ - kBack_ns || late_ns < -kBack_ns) return false;
  const std::int64_t arrival_ns = pair.stamp_ns + pair.delay_ns;
  if (late_ns < kFarLate_ns) {
    late_since_ns_ = 0;
    return true;
  }
  if (late_since_ns_ == 0) late_since_ns_ = arrival_ns;
  return arrival_ns - late_since_ns_ < kLateFor_ns;
}

void ArrivalClock::begin(const Pair& first) {
  first_ = count_ = 0;
  late_since_ns_ = 0;
  newest_ns_ = first.stamp_ns;
  other_clock_.fits();
  pairs_[count_++] = first;
  fit();
}

void ArrivalClock::add(const Pair& pair) {
  newest_ns_ = std::max(newest_ns_, pair.stamp_ns);
  Pair& last = pairs_[(first_ + count_ - 1) % kBuckets];
  const std::int64_t ahead = pair.stamp_ns / kBucket_ns - last.stamp_ns / kBucket_ns;
  if (ahead == 0 && pair.delay_ns < last.delay_ns) last = pair;
  if (ahead <= 0) return;
  if (count_ == kBuckets) {
    first_ = (first_ + 1) % kBuckets;
    --count_;
  }
  pairs_[(first_ + count_++) % kBuckets] = pair;
}

/// The edge of the pairs' lower hull above the middle of their stamps: of all lines below them it is the one
/// closest to them on the whole.
void ArrivalClock::fit() {
  const Pair& oldest = from_oldest(0);
  const Pair& newest = from_oldest(count_ - 1);
  std::array<std::size_t, kBuckets> hull{};
  std::size_t corners = 0;
  const auto x = [&](std::size_t i) {
    return static_cast<double>(from_oldest(i).stamp_ns - oldest.stamp_ns);
  };
  const auto y = [&](std::size_t i) {
    return static_cast<double>(from_oldest(i).delay_ns - oldest.delay_ns);
  };
  double middle = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    middle += x(i) / static_cast<double>(count_);
    while (corners >= 2) {
      const std::size_t a = hull[corners - 2];
      const std::size_t b = hull[corners - 1];
      if ((y(b) - y(a)) * (x(i) - x(a)) < (y(i) - y(a)) * (x(b) - x(a))) break;
      --corners;
    }
    hull[corners++] = i;
  }
  slope_ = 0;
  if (newest.stamp_ns - oldest.stamp_ns >= kLeastForSlope_ns) {
    std::size_t edge = 1;
    while (edge + 1 < corners && x(hull[edge]) < middle) ++edge;
    const double rise = y(hull[edge]) - y(hull[edge - 1]);
    slope_ = std::clamp(rise / (x(hull[edge]) - x(hull[edge - 1])), -kMostDrift, kMostDrift);
  }
  at_ns_ = newest.stamp_ns;
  double base = y(0) + slope_ * x(count_ - 1);
  for (std::size_t i = 0; i < count_; ++i) base = std::min(base, y(i) + slope_ * (x(count_ - 1) - x(i)));
  base_ns_ = oldest.delay_ns + std::llround(base);
}

std::int64_t ArrivalClock::delay_at(std::int64_t stamp_ns) const {
  return base_ns_ + std::llround(slope_ * static_cast<double>(stamp_ns - at_ns_));
}

std::int64_t ArrivalClock::arrival_of(std::int64_t stamp_ns) const {
  return stamp_ns + delay_at(stamp_ns);
}

void ArrivalClock::move(Sweep& sweep) const {
  for (std::int64_t& time_ns : sweep.times_ns) time_ns = arrival_of(time_ns);
  sweep.stamp_ns = arrival_of(sweep.stamp_ns);
}

void shift(Sweep& sweep, std::int64_t by_ns) {
  for (std::int64_t& time_ns : sweep.times_ns) time_ns += by_ns;
  sweep.stamp_ns += by_ns;
}

}  // namespace gvom::ingest
