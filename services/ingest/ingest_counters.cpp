#include "services/ingest/ingest_counters.hpp"

namespace gvom::ingest {

IngestCounters::IngestCounters(services::HealthReport& health)
    : sweeps_in(health.counter("sweeps_in")),
      sweeps_mapped(health.counter("sweeps_mapped")),
      drop_before_odometry(health.counter("drop_before_odometry")),
      drop_odometry_timeout(health.counter("drop_odometry_timeout")),
      drop_after_odometry(health.counter("drop_after_odometry")),
      drop_odometry_gap(health.counter("drop_odometry_gap")),
      drop_overrun(health.counter("drop_overrun")),
      drop_no_chunk(health.counter("drop_no_chunk")),
      drop_backend_failed(health.counter("drop_backend_failed")),
      sweep_incomplete(health.counter("sweep_incomplete")),
      drop_sweep_incomplete(health.counter("drop_sweep_incomplete")),
      odometry_in(health.counter("odometry_in")),
      odometry_lost(health.counter("odometry_lost")),
      drop_odometry_not_finite(health.counter("drop_odometry_not_finite")),
      drop_odometry_not_newer(health.counter("drop_odometry_not_newer")),
      odometry_gaps(health.counter("odometry_gaps")),
      odometry_jumps(health.counter("odometry_jumps")),
      returns_used(health.counter("returns_used")),
      drop_return_not_finite(health.counter("drop_return_not_finite")),
      drop_return_near(health.counter("drop_return_near")),
      drop_return_far(health.counter("drop_return_far")),
      drop_return_body(health.counter("drop_return_body")),
      drop_return_overflow(health.counter("drop_return_overflow")),
      packets(health.counter("packets")),
      drop_packet_foreign(health.counter("drop_packet_foreign")),
      drop_packet_second_sensor(health.counter("drop_packet_second_sensor")),
      drop_packet_truncated(health.counter("drop_packet_truncated")),
      drop_packet_duplicate(health.counter("drop_packet_duplicate")),
      drop_packet_late(health.counter("drop_packet_late")),
      drop_packet_fragment(health.counter("drop_packet_fragment")),
      drop_packet_kernel(health.counter("drop_packet_kernel")),
      packet_out_of_order(health.counter("packet_out_of_order")),
      column_invalid(health.counter("column_invalid")),
      column_missing(health.counter("column_missing")),
      epochs(health.counter("epochs")),
      wait(health.stage("wait_for_odometry")),
      voxelize(health.stage("voxelize")) {}

void IngestCounters::add(const FilterCounts& filter) {
  returns_used += filter.used;
  drop_return_not_finite += filter.not_finite;
  drop_return_near += filter.too_near;
  drop_return_far += filter.too_far;
  drop_return_body += filter.body;
}

void IngestCounters::copy(const SourceCounters& source, std::uint64_t overruns, std::uint64_t lost) {
  sweeps_in = source.sweeps;
  drop_overrun = overruns;
  sweep_incomplete = source.incomplete_sweeps;
  drop_sweep_incomplete = source.dropped_sweeps;
  odometry_lost = lost;
  drop_return_overflow = source.overflow_returns;
  packets = source.packets;
  drop_packet_foreign = source.foreign_packets;
  drop_packet_second_sensor = source.second_sensor_packets;
  drop_packet_truncated = source.truncated_packets;
  drop_packet_duplicate = source.duplicate_packets;
  drop_packet_late = source.late_packets;
  drop_packet_fragment = source.lost_fragments;
  drop_packet_kernel = source.kernel_drops;
  packet_out_of_order = source.out_of_order_packets;
  column_invalid = source.invalid_columns;
  column_missing = source.missing_columns;
}

}  // namespace gvom::ingest
