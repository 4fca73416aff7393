// Ground with slopes, ditches and cliffs, and what stands and hangs on it: where random drives see points.
#pragma once

#include <Eigen/Core>

#include "core/config.hpp"
#include "tests/core/random.hpp"

namespace gvom::test {

class RandomWorld {
 public:
  RandomWorld(Random& random, const MapConfig& map);

  /// Height of the ground, metres in odom.
  [[nodiscard]] double ground_m(double x_m, double y_m) const;
  /// A point that is seen from a vehicle there: of the ground, of a crown, a trunk or a bush, or a mirrored
  /// one below the ground.
  [[nodiscard]] Eigen::Vector3d point(Random& random, const Eigen::Vector3d& vehicle_m) const;

 private:
  double extent_m_, base_m_, slope_x_, slope_y_, bend_per_m_, ditch_width_m_, ditch_depth_m_, cliff_m_,
      noise_m_;
};

}  // namespace gvom::test
