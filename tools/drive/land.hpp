// The ground of courses: hills, with ditches and banks across the way that have a way around.
#pragma once

#include <vector>

#include "tools/sim/scenes/ground.hpp"

namespace gvom::driving {

/// A step of the ground across x: a face of 65 degrees that becomes a gentle ramp towards one end.
struct Bank {
  double upper_x_m = 0;  ///< The upper edge; the ground falls from it towards -x or +x.
  double height_m = 1.5;
  bool goes_up = true;     ///< Seen along +x.
  double gentle_y_m = 10;  ///< From here on it gets gentle, over `kTwist_m`;
  double side = 1;         ///< towards +y (1) or -y (-1).

  static constexpr double kTwist_m = 10;

  /// Above the ground before the bank; `point` is of what is there without it.
  [[nodiscard]] sim::GroundPoint on(const sim::GroundPoint& point, double x_m, double y_m) const;
};

struct Land {
  sim::Relief relief;
  std::vector<sim::Ditch> ditches;
  std::vector<Bank> banks;

  [[nodiscard]] sim::GroundPoint at(double x_m, double y_m) const;
};

}  // namespace gvom::driving
