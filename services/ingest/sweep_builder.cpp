#include "services/ingest/sweep_builder.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace gvom::ingest {

SweepBuilder::SweepBuilder(const SourceOptions& options, std::size_t max_times, SourceCounters& counters)
    : min_fraction_(options.min_sweep_fraction),
      max_returns_(options.max_returns),
      max_times_(max_times),
      counters_(counters) {
  discard();
}

void SweepBuilder::discard() {
  open_.clear();
  open_.returns.reserve(max_returns_);
  open_.times_ns.reserve(max_times_);
  last_return_ns_ = std::numeric_limits<std::int64_t>::min();
}

std::uint32_t SweepBuilder::add_time(std::int64_t time_ns) {
  open_.times_ns.push_back(time_ns);
  return static_cast<std::uint32_t>(open_.times_ns.size() - 1);
}

void SweepBuilder::append(const Return* returns, std::size_t count) {
  const std::size_t taken = std::min(count, max_returns_ - open_.returns.size());
  counters_.overflow_returns += count - taken;
  if (taken == 0) return;
  open_.returns.insert(open_.returns.end(), returns, returns + taken);
  last_return_ns_ = std::max(last_return_ns_, open_.times_ns.back());
}

bool SweepBuilder::close(double fraction, bool complete, Sweep& out) {
  if (open_.times_ns.empty() || fraction < min_fraction_) {
    const double had = open_.times_ns.empty() ? 0 : std::clamp(fraction, 0.0, 1.0);
    ++counters_.dropped_sweeps;
    counters_.dropped_fractions += had;
    counters_.best_dropped_fraction = std::max(counters_.best_dropped_fraction, had);
    discard();
    return false;
  }
  open_.stamp_ns = last_return_ns_;
  if (open_.returns.empty()) {
    open_.stamp_ns = *std::max_element(open_.times_ns.begin(), open_.times_ns.end());
  }
  open_.complete = complete;
  open_.columns_seen_fraction = complete ? 1.0 : fraction;
  ++counters_.sweeps;
  if (!complete) ++counters_.incomplete_sweeps;
  std::swap(open_, out);
  discard();
  return true;
}

}  // namespace gvom::ingest
