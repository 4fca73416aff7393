// What an ingest process counts, as Health tells it. Everything that is dropped is in exactly one of these.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/returns.hpp"
#include "services/common/health.hpp"
#include "services/ingest/odometry_intake.hpp"
#include "services/ingest/sweep_reader.hpp"

namespace gvom::ingest {

/// What the source counts, and what the loop counts of what comes out of it.
struct IngestCounts : SourceCounters {
  std::uint64_t mapped_sweeps = 0;
  std::uint64_t before_odometry = 0;
  std::uint64_t odometry_timeouts = 0;
  std::uint64_t waiting_overruns = 0;
  std::uint64_t after_odometry = 0;
  std::uint64_t in_odometry_gap = 0;
  std::uint64_t across_odometry_jump = 0;
  std::uint64_t of_other_clock = 0;
  std::uint64_t overruns = 0;
  std::uint64_t without_chunk = 0;
  std::uint64_t backend_failures = 0;
  std::uint64_t poses = 0;
  std::uint64_t lost_poses = 0;
  std::uint64_t not_finite_poses = 0;
  std::uint64_t not_newer_poses = 0;
  std::uint64_t old_epoch_poses = 0;
  std::uint64_t refused_poses = 0;
  std::uint64_t odometry_gaps = 0;
  std::uint64_t odometry_jumps = 0;
  std::uint64_t returns_used = 0;
  std::uint64_t returns_not_finite = 0;
  std::uint64_t returns_near = 0;
  std::uint64_t returns_far = 0;
  std::uint64_t returns_body = 0;
  std::uint64_t epochs = 0;

  void add(const FilterCounts& filter);
};

/// A counter of Health.
struct CounterRow {
  const char* name;  ///< In Health; `drop_` for what was not used.
  std::uint64_t IngestCounts::*value;
  const char* says;  ///< What it counts, in words.
};

inline constexpr CounterRow kIngestCounters[] = {
    {"sweeps_in", &IngestCounts::sweeps, "sweeps that came from the source"},
    {"sweeps_mapped", &IngestCounts::mapped_sweeps, "sweeps mapped"},
    {"drop_before_odometry", &IngestCounts::before_odometry, "sweeps from before the first pose"},
    {"drop_odometry_timeout", &IngestCounts::odometry_timeouts, "sweeps that no pose came for in time"},
    {"drop_odometry_full", &IngestCounts::waiting_overruns, "sweeps without room to wait for a pose"},
    {"drop_after_odometry", &IngestCounts::after_odometry, "sweeps left when the replay ended"},
    {"drop_odometry_gap", &IngestCounts::in_odometry_gap, "sweeps that reach into a gap"},
    {"drop_odometry_jump", &IngestCounts::across_odometry_jump, "sweeps that reach across a jump"},
    {"drop_clock_offset", &IngestCounts::of_other_clock, "sweeps of another clock than the odometry's"},
    {"drop_overrun", &IngestCounts::overruns, "sweeps that the loop was too slow for"},
    {"drop_no_chunk", &IngestCounts::without_chunk, "maps that shared memory had no room for"},
    {"drop_backend_failed", &IngestCounts::backend_failures, "sweeps lost with the back end"},
    {"sweep_incomplete", &IngestCounts::incomplete_sweeps, "sweeps with columns missing, used"},
    {"drop_sweep_incomplete", &IngestCounts::dropped_sweeps, "sweeps of less than min_sweep_fraction"},
    {"drop_sweep_misfit", &IngestCounts::misfit_sweeps,
     "sweeps of another mode or pace than the source says"},
    {"drop_sweep_withheld", &IngestCounts::withheld_sweeps, "sweeps of a sender that is on trial"},
    {"odometry_in", &IngestCounts::poses, "poses that came"},
    {"odometry_lost", &IngestCounts::lost_poses, "poses that the queue had no room for"},
    {"drop_odometry_not_finite", &IngestCounts::not_finite_poses, "poses that are none"},
    {"drop_odometry_not_newer", &IngestCounts::not_newer_poses, "poses that go back in time, or repeat one"},
    {"drop_odometry_old_epoch", &IngestCounts::old_epoch_poses, "poses of an old epoch"},
    {"drop_odometry_refused", &IngestCounts::refused_poses, "odometry messages of another version or kind"},
    {"odometry_gaps", &IngestCounts::odometry_gaps, "gaps in the odometry"},
    {"odometry_jumps", &IngestCounts::odometry_jumps, "jumps of the odometry"},
    {"returns_used", &IngestCounts::returns_used, "returns used"},
    {"drop_return_not_finite", &IngestCounts::returns_not_finite, "returns that are no point"},
    {"drop_return_near", &IngestCounts::returns_near, "returns nearer than range_min_m"},
    {"drop_return_far", &IngestCounts::returns_far, "returns farther than range_max_m"},
    {"drop_return_body", &IngestCounts::returns_body, "returns from the vehicle itself"},
    {"drop_return_overflow", &IngestCounts::overflow_returns, "returns beyond max_returns"},
    {"packets", &IngestCounts::packets, "packets that came to the decoder"},
    {"drop_packet_foreign", &IngestCounts::foreign_packets, "packets that are not of such a sensor"},
    {"drop_packet_second_sensor", &IngestCounts::second_sensor_packets, "packets of another such sensor"},
    {"drop_packet_slow", &IngestCounts::slow_packets,
     "packets of a sender that is too slow for such a sensor"},
    {"drop_packet_truncated", &IngestCounts::truncated_packets, "packets captured shorter than sent"},
    {"drop_packet_duplicate", &IngestCounts::duplicate_packets, "packets that came again"},
    {"drop_packet_late", &IngestCounts::late_packets, "packets of a sweep that is closed"},
    {"drop_packet_fragment", &IngestCounts::lost_fragments, "datagrams of which a fragment is missing"},
    {"drop_packet_kernel", &IngestCounts::kernel_drops, "packets that the socket's queue had no room for"},
    {"packet_out_of_order", &IngestCounts::out_of_order_packets, "packets out of order, used"},
    {"column_invalid", &IngestCounts::invalid_columns,
     "columns that the sensor marks invalid, or that cannot be"},
    {"column_missing", &IngestCounts::missing_columns, "columns that never came"},
    {"epochs", &IngestCounts::epochs, "times that the odometry's clock began anew"},
};

/// The counts of one process and how Health gets them.
class IngestCounters : public IngestCounts {
 public:
  explicit IngestCounters(services::HealthReport& health);

  /// What the source and its reader counted so far, and what the intake did.
  void take(const SourceCounters& source, const SweepReader::Overruns& overruns);
  void take(const OdometryCounts& odometry, const SweepLosses& losses);

  /// Puts everything into the next Health.
  void report();

  /// "12 sweeps from before the first pose, 3 ...": all that was dropped, for the log; empty if nothing was.
  [[nodiscard]] std::string dropped() const;

  services::StageHistogram& wait;  ///< Received -> odometry there.
  services::StageHistogram& voxelize;

 private:
  std::array<std::uint64_t*, std::size(kIngestCounters)> reported_{};
};

}  // namespace gvom::ingest
