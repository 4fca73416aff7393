// Whether a pose can be trusted to follow from the one before it.
#pragma once

#include <optional>

#include "core/odometry_buffer.hpp"
#include "services/common/vehicle_config.hpp"

namespace gvom::services {

/// How a pose goes on from the one before.
enum class PoseStep {
  steady,
  gap,         ///< Too long after it: what lies between is not known well enough to place a sweep by.
  jump,        ///< Farther away than the vehicle can go: maps from before lie wrongly to those after.
  anew,        ///< After many that went back in time: the one that they went back from was wrong.
  not_a_pose,  ///< Not finite, or too far away. Not to be used.
  repeated,    ///< As old as the one before. Not to be used.
  backwards,   ///< Older than the one before. Not to be used.
};

/// Live and recorded poses alike.
class PoseJudge {
 public:
  static constexpr int kAnew = 8;  ///< Poses in a row that go back in time: then the clock did.

  explicit PoseJudge(const OdometryConfig& config)
      : max_gap_s_(config.max_gap_s), max_speed_mps_(config.max_speed_mps) {}

  struct Verdict {
    PoseStep step;
    double value = 0;  ///< Of a gap, seconds; of a jump, metres.
  };
  Verdict judge(const StampedPose& pose);

  /// The next pose follows nothing.
  void begin_anew();

 private:
  [[nodiscard]] bool jumps(const StampedPose& pose) const;

  double max_gap_s_;
  double max_speed_mps_;
  std::optional<StampedPose> last_;
  int backwards_ = 0;  // poses in a row that went back in time
};

}  // namespace gvom::services
