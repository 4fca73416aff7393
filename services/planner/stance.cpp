#include "services/planner/stance.hpp"

#include <algorithm>
#include <array>

namespace gvom::planner {
namespace {

using Eigen::Vector2d;

Vector2d odom_of(const Pose2& pose, const Vector2d& forward, double ahead_m, double left_m) {
  return {pose.x_m + ahead_m * forward.x() - left_m * forward.y(),
          pose.y_m + ahead_m * forward.y() + left_m * forward.x()};
}

/// Front left, front right, rear left, rear right.
std::array<Vector2d, 4> wheels_at(const VehicleLimits& vehicle, const Pose2& pose) {
  const Vector2d forward = pose.forward();
  const double left_m = vehicle.track_m / 2;
  return {odom_of(pose, forward, vehicle.front_axle_m, left_m),
          odom_of(pose, forward, vehicle.front_axle_m, -left_m),
          odom_of(pose, forward, -vehicle.rear_axle_m, left_m),
          odom_of(pose, forward, -vehicle.rear_axle_m, -left_m)};
}

/// z = z_m + ahead * ahead_m + left * left_m, from base_link.
struct Plane {
  double z_m = 0;
  double ahead = 0;
  double left = 0;
};

/// The highest of the cells whose middles lie between the wheels, above the plane.
double belly_above(const MapView& map, const VehicleLimits& vehicle, const Pose2& pose, const Plane& plane) {
  const Cells cells = map.cells();
  const Vector2d forward = pose.forward();
  const double reach_m = std::hypot(std::max(vehicle.front_axle_m, vehicle.rear_axle_m), vehicle.track_m / 2);
  const auto cell = [&](double place_m, double corner_m) {
    return std::clamp(static_cast<int>(std::floor((place_m - corner_m) / cells.cell_m)), 0, cells.n - 1);
  };
  double most_m = 0;
  for (int y = cell(pose.y_m - reach_m, cells.y_m); y <= cell(pose.y_m + reach_m, cells.y_m); ++y)
    for (int x = cell(pose.x_m - reach_m, cells.x_m); x <= cell(pose.x_m + reach_m, cells.x_m); ++x) {
      const int index = y * cells.n + x;
      const Vector2d from = cells.center_of(index) - pose.place();
      const double ahead_m = from.dot(forward), left_m = forward.x() * from.y() - forward.y() * from.x();
      if (ahead_m > vehicle.front_axle_m || ahead_m < -vehicle.rear_axle_m ||
          std::abs(left_m) > vehicle.track_m / 2)
        continue;
      // NaN is not greater: unknown ground does not touch the belly.
      const double above_m = map.height[index] - (plane.z_m + plane.ahead * ahead_m + plane.left * left_m);
      if (above_m > most_m) most_m = above_m;
    }
  return most_m;
}

}  // namespace

double height_at(const MapView& map, double x_m, double y_m) {
  const Cells cells = map.cells();
  const int own = cells.index_of(x_m, y_m);
  if (own < 0 || std::isnan(map.height[own])) return std::nan("");
  const double x = (x_m - cells.x_m) / cells.cell_m - 0.5, y = (y_m - cells.y_m) / cells.cell_m - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  double sum_m = 0, weights = 0;
  for (int dy = 0; dy < 2; ++dy)
    for (int dx = 0; dx < 2; ++dx) {
      if (!cells.contains(x0 + dx, y0 + dy)) continue;
      const double height_m = map.height[(y0 + dy) * cells.n + x0 + dx];
      if (std::isnan(height_m)) continue;
      const double weight = (1 - std::abs(x - (x0 + dx))) * (1 - std::abs(y - (y0 + dy)));
      sum_m += weight * height_m;
      weights += weight;
    }
  return sum_m / weights;
}

Stance stance_at(const MapView& map, const VehicleLimits& vehicle, const Pose2& pose) {
  std::array<double, 4> z_m{};
  const auto wheels = wheels_at(vehicle, pose);
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    z_m[i] = height_at(map, wheels[i].x(), wheels[i].y());
    if (std::isnan(z_m[i])) return {};
  }
  const double base_m = std::max(vehicle.front_axle_m + vehicle.rear_axle_m, 1e-6);
  Plane plane;
  plane.ahead = (z_m[0] + z_m[1] - z_m[2] - z_m[3]) / 2 / base_m;
  plane.left = (z_m[0] + z_m[2] - z_m[1] - z_m[3]) / 2 / vehicle.track_m;
  const double middle_m = (vehicle.front_axle_m - vehicle.rear_axle_m) / 2;
  plane.z_m = (z_m[0] + z_m[1] + z_m[2] + z_m[3]) / 4 - plane.ahead * middle_m;

  Stance stance;
  stance.known = true;
  stance.z_m = plane.z_m;
  stance.pitch_rad = -std::atan(plane.ahead);
  stance.roll_rad = std::atan(plane.left * std::cos(stance.pitch_rad));
  stance.belly_m = belly_above(map, vehicle, pose, plane);
  return stance;
}

double strain_of(const Stance& stance, const VehicleLimits& vehicle) {
  return std::max({std::abs(stance.roll_rad) / vehicle.max_roll_rad,
                   std::abs(stance.pitch_rad) / vehicle.max_pitch_rad,
                   stance.belly_m / vehicle.ground_clearance_m});
}

double roughness_at(const MapView& map, const VehicleLimits& vehicle, const Pose2& pose) {
  const Cells cells = map.cells();
  double most_m2 = 0;
  for (const Vector2d& wheel : wheels_at(vehicle, pose)) {
    const int index = cells.index_of(wheel.x(), wheel.y());
    if (index >= 0 && map.roughness[index] > most_m2) most_m2 = map.roughness[index];
  }
  return most_m2;
}

}  // namespace gvom::planner
