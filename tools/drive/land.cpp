#include "tools/drive/land.hpp"

#include <algorithm>

namespace gvom::driving {
namespace {

constexpr double kSteepRun = 0.47;  // of the height: 65 degrees
constexpr double kGentleRun = 9.0;  // of the height: 6 degrees
constexpr double kFaceSlope = 0.6;  // steeper ramps are faces

}  // namespace

sim::GroundPoint Bank::on(const sim::GroundPoint& point, double x_m, double y_m) const {
  const double part = std::clamp(side * (y_m - gentle_y_m) / kTwist_m, 0.0, 1.0);
  const double smooth = part * part * (3 - 2 * part);
  const double run_m = height_m * (kSteepRun + smooth * (kGentleRun - kSteepRun));
  const double below_m = goes_up ? upper_x_m - x_m : x_m - upper_x_m;  // from the upper edge outwards
  const double fallen = std::clamp(below_m / run_m, 0.0, 1.0);
  sim::GroundPoint out = point;
  out.height_m += goes_up ? height_m * (1 - fallen) : -height_m * fallen;
  if (fallen > 0 && fallen < 1 && height_m / run_m > kFaceSlope) out.surface = sim::Surface::face;
  return out;
}

sim::GroundPoint Land::at(double x_m, double y_m) const {
  double depth_m = 0;
  for (const sim::Ditch& ditch : ditches) depth_m = std::max(depth_m, ditch.depth_at(x_m, y_m));
  sim::GroundPoint point = sim::dug(relief.height_m(x_m, y_m), depth_m);
  for (const Bank& bank : banks) point = bank.on(point, x_m, y_m);
  return point;
}

}  // namespace gvom::driving
