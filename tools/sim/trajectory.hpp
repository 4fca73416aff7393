// How the vehicle drives: along a path at constant speed, pitching and rolling with the ground.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tools/sim/motion.hpp"
#include "tools/sim/odometry_errors.hpp"
#include "tools/sim/terrain.hpp"

namespace gvom::sim {

struct Drive {
  double speed_mps = 5.0;
  double base_height_m = 0.0;  ///< Of base_link above the ground (R9).
};

class Trajectory : public Motion {
 public:
  /// `path_m` holds at least two places; its corners are rounded off. Each wheel stands on the mean height of
  /// a patch of ground, and bridges what is a hole or a face.
  Trajectory(const Terrain& terrain, const std::vector<Eigen::Vector2d>& path_m, const Drive& drive);

  /// Straight on for a little before the start and after the end too.
  [[nodiscard]] Pose at(double time_s) const override;

  /// From the path's first point to its end.
  [[nodiscard]] double seconds() const { return length_m_ / drive_.speed_mps; }

 private:
  /// Where the vehicle is at one of equal steps along its way.
  struct Station {
    Eigen::Vector2d middle_m;
    Eigen::Vector2d forward;  ///< Of length 1.
    double ground_m;          ///< Mean height of the wheels.
    double pitch_rad;
    double roll_rad;
  };

  void lean_on(const Terrain& terrain);

  Drive drive_;
  double length_m_ = 0.0;
  std::vector<Station> stations_;
};

/// Poses at `rate_hz`, from 50 ms before `begin_ns` to 50 ms after `end_ns`. `start_ns` is the start of
/// the drive.
struct OdometrySpan {
  std::int64_t start_ns;
  std::int64_t begin_ns;
  std::int64_t end_ns;
  int rate_hz;
};
std::vector<StampedPose> make_odometry(const Motion& motion, const OdometrySpan& span,
                                       const OdometryNoise& noise, std::uint64_t seed);

}  // namespace gvom::sim
