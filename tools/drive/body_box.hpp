// The vehicle's box and what it meets.
#pragma once

#include "core/pose.hpp"
#include "tools/drive/vehicle_model.hpp"
#include "tools/sim/primitives.hpp"

namespace gvom::driving {

/// From the ground clearance up to the vehicle's height, over its whole outline, leaning with it.
class BodyBox {
 public:
  BodyBox(const VehicleModel& model, const Pose& T_odom_base);

  /// Whether a body reaches into the box, as lines through the box at most 5 cm apart see it.
  [[nodiscard]] bool meets(const sim::Primitive& body) const;

  /// Corners of its axis-aligned box in odom.
  [[nodiscard]] const Eigen::Vector3d& lower() const { return lower_; }
  [[nodiscard]] const Eigen::Vector3d& upper() const { return upper_; }

 private:
  Eigen::Isometry3d T_odom_base_;
  Eigen::Vector3d from_m_, to_m_;  // corners in base_link
  Eigen::Vector3d lower_, upper_;
};

}  // namespace gvom::driving
