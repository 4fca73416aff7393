// The one place where odometry comes in, live or recorded, and that says which sweeps it can place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/odometry_buffer.hpp"
#include "core/sweep.hpp"
#include "services/common/pose_judge.hpp"
#include "services/common/vehicle_config.hpp"
#include "services/common/words.hpp"
#include "services/ingest/clock_check.hpp"
#include "services/ingest/sightings.hpp"
#include "services/ingest/sweep_losses.hpp"

namespace gvom::ingest {

/// One message of the odometry, or one line of a recording of it (epoch 0).
struct OdometryNews {
  StampedPose pose;
  std::uint64_t epoch = 0;
  bool end_of_stream = false;  ///< Nothing follows in this epoch; the pose repeats the last one.
};

/// What became of it.
enum class Taken { used, gap, jump, anew, not_a_pose, backwards, old_epoch, end };

/// Of all that came.
struct OdometryCounts {
  std::uint64_t poses = 0;  ///< Of the epochs that were current.
  std::uint64_t not_finite = 0;
  std::uint64_t not_newer = 0;
  std::uint64_t old_epoch = 0;
  std::uint64_t refused = 0;  ///< By who took the messages: of another version or kind.
  std::uint64_t gaps = 0;
  std::uint64_t jumps = 0;
};

/// In the order in which they are told.
enum class OdometryFault {
  clock,
  silence,
  jump,
  gap,
  timeout,
  backwards,
  not_finite,
  old_epoch,
  refused,
  count
};

/// Whether a sweep can be placed, and if never, why.
struct Placement {
  enum class When { now, later, never };
  When when = When::later;
  SweepLoss why = SweepLoss::count;
};

/// Ingest, a replay and gvom-map ask this same code. Knows no bus and no clock: times of CLOCK_MONOTONIC are
/// handed in. Allocates at construction only.
class OdometryIntake {
 public:
  enum class Sweeps { live, recorded };

  /// @param capacity poses kept
  OdometryIntake(const services::OdometryConfig& config, Sweeps sweeps, std::size_t capacity = 8192);

  /// A message that came at `now_ns`. One of a higher epoch begins anew: no pose from before it is kept.
  Taken take(const OdometryNews& news, std::int64_t now_ns);

  /// Messages that could not be read, so many in all, and why the newest could not.
  void note_refused(std::uint64_t all, const std::string& why, std::int64_t now_ns);

  /// A live sweep waits for odometry for `odometry.timeout_s`, a recorded one until the odometry ends. A live
  /// one whose clock seems to be another than the odometry's waits a moment for odometry that says otherwise.
  /// @param since_ns since when it is there
  [[nodiscard]] Placement judge(const Sweep& sweep, std::int64_t since_ns, std::int64_t now_ns) const;

  /// Tells of a sweep that can never be placed.
  void note(const Sweep& sweep, SweepLoss why, std::int64_t now_ns);

  [[nodiscard]] const OdometryBuffer& poses() const { return poses_; }
  [[nodiscard]] const OdometryCounts& counts() const { return counts_; }
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }
  [[nodiscard]] bool has_ended() const { return ended_; }
  [[nodiscard]] std::int64_t came_ns() const { return came_ns_; }  ///< When the newest message came.
  /// From the first to the last pose of this epoch.
  [[nodiscard]] const std::optional<TimeSpan>& span() const { return span_; }

  /// A bit for each fault of the odometry at `now_ns`.
  [[nodiscard]] std::uint32_t faults(std::int64_t now_ns) const;
  void describe(std::int64_t now_ns, services::Words& words) const;

  [[nodiscard]] const services::OdometryConfig& config() const { return config_; }

 private:
  void begin_epoch(std::uint64_t epoch);
  Taken take_pose(const StampedPose& pose, std::int64_t now_ns);
  Taken note_step(const services::PoseJudge::Verdict& verdict, std::int64_t now_ns);
  [[nodiscard]] bool is_silent(std::int64_t now_ns) const;
  [[nodiscard]] std::optional<std::int64_t> ahead_ns(const Sweep& sweep) const;
  void describe_clock(services::Words& words) const;

  const services::OdometryConfig config_;
  const bool live_;
  services::PoseJudge judge_;
  OdometryBuffer poses_;
  OdometryCounts counts_;
  Sightings<OdometryFault> seen_;
  ClockCheck clock_;
  const char* clock_guess_ = "";
  std::string refusal_;
  std::uint64_t epoch_ = 0;
  bool ended_ = false;
  std::int64_t came_ns_ = 0;
  std::optional<TimeSpan> span_;
};

}  // namespace gvom::ingest
