#include "tests/core/random_world.hpp"

#include <cmath>

namespace gvom::test {

namespace {

// How far along a period of the world, 0 .. 1.
double share(double at_m, double period_m) {
  return at_m / period_m - std::floor(at_m / period_m);
}

}  // namespace

RandomWorld::RandomWorld(Random& random, const MapConfig& map)
    : extent_m_(map.size_xy * map.resolution_xy_m),
      base_m_(random.pick({0.0, 0.13, -40.2})),
      slope_x_(random.pick({0.0, 0.0, 0.1, -0.4})),
      slope_y_(random.pick({0.0, 0.0, 0.3, -0.1})),
      bend_per_m_(random.pick({0.0, 0.0, 0.02})),
      ditch_width_m_(random.pick({0.0, 0.1, 0.15}) * extent_m_),
      ditch_depth_m_(random.pick({0.3, 1.0})),
      cliff_m_(random.pick({0.0, 0.0, 1.5})),
      noise_m_(random.pick({0.0, 0.02, 0.15})) {}

double RandomWorld::ground_m(double x_m, double y_m) const {
  const double along_m = share(x_m, 0.7 * extent_m_) * 0.7 * extent_m_;
  const double in_ditch = along_m > 0.35 * extent_m_ && along_m < 0.35 * extent_m_ + ditch_width_m_ ? 1 : 0;
  const double under_cliff = share(y_m, 1.3 * extent_m_) > 0.8 ? 1 : 0;
  const double middle_m = along_m - 0.2 * extent_m_;
  return base_m_ + slope_x_ * middle_m + slope_y_ * share(y_m, extent_m_) * extent_m_ -
         bend_per_m_ * middle_m * middle_m - in_ditch * ditch_depth_m_ - under_cliff * cliff_m_;
}

Eigen::Vector3d RandomWorld::point(Random& random, const Eigen::Vector3d& vehicle_m) const {
  const double reach_m = 0.5 * extent_m_, apart_m = 0.23 * extent_m_;
  double x_m = vehicle_m.x() + random.uniform(-reach_m, reach_m);
  double y_m = vehicle_m.y() + random.uniform(-reach_m, reach_m);
  double above_m = random.uniform(-noise_m_, noise_m_);
  const int kind = random.integer(0, 99);
  if (kind < 30) {  // of one of the things that stand each `apart_m`
    const double spread_m = kind < 12 ? 0.05 * extent_m_ : 0.1;
    x_m = std::round(x_m / apart_m) * apart_m + random.uniform(-spread_m, spread_m);
    y_m = std::round(y_m / apart_m) * apart_m + random.uniform(-spread_m, spread_m);
    above_m = kind < 12 ? random.uniform(1.5, 4) : random.uniform(0, kind < 23 ? 3 : 0.9);
  } else if (kind < 34) {
    above_m = -random.uniform(0, 2);
  }
  return {x_m, y_m, ground_m(x_m, y_m) + above_m};
}

}  // namespace gvom::test
