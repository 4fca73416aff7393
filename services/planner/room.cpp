#include "services/planner/room.hpp"

#include <algorithm>

namespace gvom::planner {

double room_m(const Costmap& costs, const VehicleLimits& vehicle, const Pose2& pose) {
  const Cells& cells = costs.cells();
  const Eigen::Vector2d forward = pose.forward();
  const double half_length_m = vehicle.length_m() / 2, half_width_m = vehicle.width_m / 2;
  const Eigen::Vector2d middle_m = pose.place() + (vehicle.front_m - half_length_m) * forward;
  const double reach_m = std::hypot(half_length_m, half_width_m) + kRoomFar_m;
  const auto cell = [&](double place_m, double corner_m) {
    return std::clamp(static_cast<int>(std::floor((place_m - corner_m) / cells.cell_m)), 0, cells.n - 1);
  };
  double least_m = kRoomFar_m;
  for (int y = cell(middle_m.y() - reach_m, cells.y_m); y <= cell(middle_m.y() + reach_m, cells.y_m); ++y)
    for (int x = cell(middle_m.x() - reach_m, cells.x_m); x <= cell(middle_m.x() + reach_m, cells.x_m); ++x) {
      if (!costs.lethal()[y * cells.n + x]) continue;
      const Eigen::Vector2d off = cells.center_of(y * cells.n + x) - middle_m;
      const double ahead_m = std::abs(off.dot(forward)) - half_length_m;
      const double aside_m = std::abs(forward.x() * off.y() - forward.y() * off.x()) - half_width_m;
      const double outside_m = std::hypot(std::max(ahead_m, 0.0), std::max(aside_m, 0.0));
      least_m = std::min(least_m, outside_m + std::min(0.0, std::max(ahead_m, aside_m)));
    }
  return least_m;
}

}  // namespace gvom::planner
