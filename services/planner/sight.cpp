#include "services/planner/sight.hpp"

#include <cmath>

namespace gvom::planner {

Sight::Sight(const VehicleLimits& vehicle) : vehicle_(vehicle) {
  const double front_m = vehicle.front_m + kSide_m, rear_m = vehicle.rear_m + kSide_m;
  const double side_m = vehicle.width_m / 2 + kSide_m;
  const int across = static_cast<int>(std::ceil(2 * side_m / kBetween_m));
  for (int i = 0; i <= across; ++i) outline_m_.emplace_back(front_m, side_m * (2.0 * i / across - 1));
  const int along = static_cast<int>(std::ceil((front_m + rear_m) / kBetween_m));
  for (int i = 1; i <= along; ++i)
    for (const double side : {-1.0, 1.0})
      outline_m_.emplace_back(front_m - (front_m + rear_m) * i / along, side * side_m);
}

bool Sight::is_under(const Eigen::Vector2d& place_m, const Pose2& start) const {
  const Eigen::Vector2d off = place_m - start.place(), forward = start.forward();
  const double ahead_m = off.dot(forward), left_m = forward.x() * off.y() - forward.y() * off.x();
  return ahead_m <= vehicle_.front_m + kUnder_m && ahead_m >= -vehicle_.rear_m - kUnder_m &&
         std::abs(left_m) <= vehicle_.width_m / 2 + kUnder_m;
}

bool Sight::is_known(const Costmap& costs, const Pose2& pose, const Pose2& start) const {
  const Eigen::Vector2d forward = pose.forward();
  for (const Eigen::Vector2d& at_m : outline_m_) {
    const Eigen::Vector2d place(pose.x_m + at_m.x() * forward.x() - at_m.y() * forward.y(),
                                pose.y_m + at_m.x() * forward.y() + at_m.y() * forward.x());
    const int index = costs.cells().index_of(place.x(), place.y());
    if ((index < 0 || costs.known()[index] == 0) && !is_under(place, start)) return false;
  }
  return true;
}

}  // namespace gvom::planner
