// What an ingest process counts, as Health tells it. Everything that is dropped is in exactly one of these.
#pragma once

#include <cstdint>

#include "core/returns.hpp"
#include "services/common/health.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

struct IngestCounters {
  explicit IngestCounters(services::HealthReport& health);

  void add(const FilterCounts& filter);
  /// Copies what the source and the odometry topic count themselves.
  void copy(const SourceCounters& source, std::uint64_t overruns, std::uint64_t odometry_lost);

  std::uint64_t& sweeps_in;
  std::uint64_t& sweeps_mapped;
  std::uint64_t& drop_before_odometry;   // sweeps from before the first pose
  std::uint64_t& drop_odometry_timeout;  // sweeps that no pose came for
  std::uint64_t& drop_after_odometry;    // left when a replay ended
  std::uint64_t& drop_odometry_gap;      // live sweeps that reach into a gap or a jump
  std::uint64_t& drop_overrun;           // live sweeps that the loop was too slow for
  std::uint64_t& drop_no_chunk;          // shared memory exhausted
  std::uint64_t& drop_backend_failed;    // the last one then: the process leaves
  std::uint64_t& sweep_incomplete;
  std::uint64_t& drop_sweep_incomplete;
  std::uint64_t& odometry_in;
  std::uint64_t& odometry_lost;
  std::uint64_t& drop_odometry_not_finite;
  std::uint64_t& drop_odometry_not_newer;
  std::uint64_t& odometry_gaps;
  std::uint64_t& odometry_jumps;
  std::uint64_t& returns_used;
  std::uint64_t& drop_return_not_finite;
  std::uint64_t& drop_return_near;
  std::uint64_t& drop_return_far;
  std::uint64_t& drop_return_body;
  std::uint64_t& drop_return_overflow;
  std::uint64_t& packets;
  std::uint64_t& drop_packet_foreign;
  std::uint64_t& drop_packet_second_sensor;
  std::uint64_t& drop_packet_truncated;
  std::uint64_t& drop_packet_duplicate;
  std::uint64_t& drop_packet_late;
  std::uint64_t& drop_packet_fragment;
  std::uint64_t& drop_packet_kernel;
  std::uint64_t& packet_out_of_order;
  std::uint64_t& column_invalid;
  std::uint64_t& column_missing;
  std::uint64_t& epochs;

  services::StageHistogram& wait;  // received -> odometry there
  services::StageHistogram& voxelize;
};

}  // namespace gvom::ingest
