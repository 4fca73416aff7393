// Where the vehicle is while it carries its lidars.
#pragma once

#include "core/pose.hpp"

namespace gvom::sim {

class Motion {
 public:
  Motion() = default;
  Motion(const Motion&) = default;
  Motion& operator=(const Motion&) = default;
  virtual ~Motion() = default;

  /// T_odom_base `time_s` after the start of the drive; also a little before it.
  [[nodiscard]] virtual Pose at(double time_s) const = 0;
};

}  // namespace gvom::sim
