#include "services/ingest/ingest_counters.hpp"

#include <string_view>

namespace gvom::ingest {

void IngestCounts::add(const FilterCounts& filter) {
  returns_used += filter.used;
  returns_not_finite += filter.not_finite;
  returns_near += filter.too_near;
  returns_far += filter.too_far;
  returns_body += filter.body;
}

IngestCounters::IngestCounters(services::HealthReport& health)
    : wait(health.stage("wait_for_odometry")), voxelize(health.stage("voxelize")) {
  for (std::size_t i = 0; i < reported_.size(); ++i) reported_[i] = &health.counter(kIngestCounters[i].name);
}

void IngestCounters::take(const SourceCounters& source, const SweepReader::Overruns& counted) {
  static_cast<SourceCounters&>(*this) = source;
  overruns = counted.slow;
  waiting_overruns = counted.waiting;
}

void IngestCounters::take(const OdometryCounts& odometry, const SweepLosses& losses) {
  poses = odometry.poses;
  not_finite_poses = odometry.not_finite;
  not_newer_poses = odometry.not_newer;
  old_epoch_poses = odometry.old_epoch;
  refused_poses = odometry.refused;
  odometry_gaps = odometry.gaps;
  odometry_jumps = odometry.jumps;
  before_odometry = losses.of(SweepLoss::before_odometry).count;
  after_odometry = losses.of(SweepLoss::after_odometry).count;
  in_odometry_gap = losses.of(SweepLoss::gap).count;
  across_odometry_jump = losses.of(SweepLoss::jump).count;
  of_other_clock = losses.of(SweepLoss::clock).count;
  odometry_timeouts = losses.of(SweepLoss::timeout).count;
}

void IngestCounters::report() {
  for (std::size_t i = 0; i < reported_.size(); ++i) *reported_[i] = this->*kIngestCounters[i].value;
}

std::string IngestCounters::dropped() const {
  std::string text;
  for (const CounterRow& row : kIngestCounters) {
    const std::uint64_t count = this->*row.value;
    if (count == 0 || std::string_view(row.name).substr(0, 5) != "drop_") continue;
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + row.says;
  }
  return text;
}

}  // namespace gvom::ingest
