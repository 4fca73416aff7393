// Ground as the rig's lidar would see it: a beam each 0.7 degrees up and down, and each 1.5 degrees around.
#pragma once

#include <cmath>

#include "tests/core/rig.hpp"

namespace gvom::test {

/// Where a ray first is below a surface of height `z_m(x, y)`: to a tenth of a millimetre, at most 45 m off.
template <class Height>
bool meets(const Eigen::Vector3d& from_m, const Eigen::Vector3d& way, Height&& z_m,
           Eigen::Vector3d& point_m) {
  const auto is_below = [&](double range_m) {
    point_m = from_m + range_m * way;
    return point_m.z() < z_m(point_m.x(), point_m.y());
  };
  double above_m = 0, below_m = 0.05;
  for (; !is_below(below_m); below_m += 0.05) {
    if (below_m > 45) return false;
    above_m = below_m;
  }
  while (below_m - above_m > 1e-4) {
    const double middle_m = (above_m + below_m) / 2;
    (is_below(middle_m) ? below_m : above_m) = middle_m;
  }
  return is_below(below_m);
}

/// All returns of a sweep from a vehicle at `vehicle_m`, upright if it is not told.
template <class Height>
Points scan(const Eigen::Vector3d& vehicle_m, Height&& z_m,
            const Eigen::Quaterniond& lean = Eigen::Quaterniond::Identity()) {
  constexpr double kDegree = M_PI / 180;
  const Eigen::Vector3d from_m = vehicle_m + lean * kSensor_m;
  Points points;
  for (double up = -24.5; up < 10; up += 0.7)
    for (double around = 0; around < 360; around += 1.5) {
      const double flat = std::cos(up * kDegree);
      const Eigen::Vector3d way(flat * std::cos(around * kDegree), flat * std::sin(around * kDegree),
                                std::sin(up * kDegree));
      Eigen::Vector3d point_m;
      if (meets(from_m, lean * way, z_m, point_m)) points.push_back(point_m);
    }
  return points;
}

}  // namespace gvom::test
