// What is wrong with a live sensor, as its packets' counters tell it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "services/common/vehicle_config.hpp"
#include "services/common/words.hpp"
#include "services/ingest/sightings.hpp"
#include "services/ingest/source.hpp"

namespace gvom::ingest {

/// In the order in which they are told.
enum class SensorFault {
  silence,        ///< No packet for half a second.
  dropped,        ///< Every sweep has too few of its columns.
  misfit,         ///< Every sweep is of another mode or pace.
  flood,          ///< More packets than one such sensor sends.
  slow,           ///< The only sender has not a sensor's rate.
  second_sensor,  ///< Packets of this sensor's kind, of another sensor.
  other_model,    ///< Foreign packets, all of one size.
  garbage,        ///< Foreign packets of various sizes.
  refused,        ///< Messages of ROS 2 that can't be used.
  loss,           ///< Columns that never came.
  queue_loss,     ///< Packets that the socket's queue had no room for.
  cut,            ///< Returns beyond max_returns.
  duplicates,
  disorder,  ///< Packets out of order, or too late to be used.
  invalid,   ///< Columns that the sensor marks invalid.
  overrun,   ///< Sweeps that waited too long: the loop is slow, or the odometry.
  count
};

/// Judges rates over the last half second.
class SensorWatch {
 public:
  /// `most_packets_per_s`: see Source; 0: no packets, and nothing is ever wrong. `lidar` must outlive this.
  SensorWatch(double most_packets_per_s, const services::LidarConfig& lidar, std::int64_t now_ns);

  /// The counters as they stand at `now_ns` (CLOCK_MONOTONIC). Call it as often as you like.
  void update(const SourceCounters& counters, std::uint64_t overruns, std::int64_t now_ns);

  /// A bit for each fault that there is.
  [[nodiscard]] std::uint32_t faults() const { return seen_.bits(now_ns_); }
  void describe(services::Words& words) const;

 private:
  struct Look {
    SourceCounters counters;
    std::uint64_t overruns = 0;
    std::int64_t at_ns = 0;
  };
  static constexpr std::size_t kLooks = 5;  // a tenth of a second apart: half a second back from now

  void judge(const Look& before, const Look& now);
  void judge_foreign(const Look& before, const Look& now, double per_s);
  void judge_shares(const SourceCounters& before, const SourceCounters& now);
  /// Notes how bad a fault is: a rate (1/s), a share (%) or a time (s).
  void see(SensorFault fault, double value);
  void tell(SensorFault fault, double value, services::Words& words) const;

  double most_packets_per_s_;
  const services::LidarConfig& lidar_;
  std::array<Look, kLooks> looks_{};
  std::size_t looked_ = 0;
  std::int64_t heard_ns_;  // when packets last came
  std::int64_t now_ns_;
  Sightings<SensorFault> seen_;
  Address slow_address_{};
  Address second_address_{};
  KindText second_kind_{};
  KindText foreign_kind_{};
  RefusalText refusal_{};
  std::uint64_t foreign_size_ = 0;
};

}  // namespace gvom::ingest
