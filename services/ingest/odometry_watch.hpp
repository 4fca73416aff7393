// Whether live odometry can be trusted from one pose to the next.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/odometry_buffer.hpp"
#include "services/common/vehicle_config.hpp"
#include "services/common/words.hpp"

namespace gvom::ingest {

/// How a pose goes on from the one before.
enum class OdometryStep {
  steady,
  gap,   ///< Too long after it: what lies between is not known well enough to place a sweep by.
  jump,  ///< Farther away than the vehicle can go: maps from before lie wrongly to those after.
  anew,  ///< After many poses that went back in time: the one that they went back from was wrong.
};

/// In the order in which they are told.
enum class OdometryFault { silence, jump, gap, backwards, not_finite, count };

/// For live sensors only: by R3 a recording is mapped with the odometry that it has, however sparse.
class OdometryWatch {
 public:
  explicit OdometryWatch(const services::OdometryConfig& config);

  /// Judges a pose that came at `now_ns` (CLOCK_MONOTONIC). After anything but `steady` no sweep may be
  /// placed between it and the poses before.
  OdometryStep step(const StampedPose& pose, std::int64_t now_ns);
  /// What became of the pose in the buffer.
  void note(OdometryBuffer::Add result, std::int64_t now_ns);
  /// The clock begins anew: the next pose follows nothing.
  void begin_anew();

  /// A bit for each fault at `now_ns`: seen within a second before; silence: now.
  [[nodiscard]] std::uint32_t faults(std::int64_t now_ns) const;
  void describe(std::int64_t now_ns, services::Words& words) const;

 private:
  static constexpr int kAnew = 8;  // poses in a row

  [[nodiscard]] bool jumps(const StampedPose& pose) const;
  void see(OdometryFault fault, double value, std::int64_t now_ns);
  [[nodiscard]] bool is_seen(std::size_t fault, std::int64_t now_ns) const;

  double max_gap_s_;
  double max_speed_mps_;
  std::optional<StampedPose> last_;
  std::int64_t came_ns_ = 0;  // when the last pose came, of whatever kind
  int backwards_ = 0;         // poses in a row that went back in time
  struct Seen {
    double value = 0;
    std::int64_t at_ns = 0;
  };
  std::array<Seen, static_cast<std::size_t>(OdometryFault::count)> seen_{};
};

}  // namespace gvom::ingest
