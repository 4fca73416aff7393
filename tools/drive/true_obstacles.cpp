#include "tools/drive/true_obstacles.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::driving {
namespace {

/// Of a point from the outline of the vehicle.
double outside_m(const planner::VehicleLimits& vehicle, const planner::Pose2& place,
                 const Eigen::Vector2d& point) {
  const Eigen::Vector2d way = point - place.place();
  const Eigen::Vector2d forward = place.forward();
  const double ahead_m = way.dot(forward);
  const double left_m = forward.x() * way.y() - forward.y() * way.x();
  const double along_m = std::max({ahead_m - vehicle.front_m, -vehicle.rear_m - ahead_m, 0.0});
  const double beside_m = std::max(std::abs(left_m) - 0.5 * vehicle.width_m, 0.0);
  return std::hypot(along_m, beside_m);
}

/// A circle that holds a walker, seen from above.
struct Disc {
  Eigen::Vector2d middle_m;
  double radius_m;
};

Disc disc_around(const sim::Primitive& body) {
  return {0.5 * (body.lower + body.upper).head<2>(), 0.5 * (body.upper - body.lower).head<2>().maxCoeff()};
}

}  // namespace

TrueObstacles::TrueObstacles(const sim::World& world, const sim::GroundTruth& truth)
    : world_(world),
      cell_m_(truth.resolution_m),
      min_x_m_(static_cast<double>(truth.origin[0]) * truth.resolution_m),
      min_y_m_(static_cast<double>(truth.origin[1]) * truth.resolution_m),
      size_x_(truth.size_x),
      size_y_(truth.size_y),
      is_obstacle_(truth.lethal) {
  for (std::size_t i = 0; i < is_obstacle_.size(); ++i)
    if (truth.classes[i] == static_cast<std::uint8_t>(sim::ObjectClass::rock)) is_obstacle_[i] = 1;
}

double TrueObstacles::nearest_m(const planner::VehicleLimits& vehicle, const planner::Pose2& place,
                                double time_s) const {
  const double reach_m = kReach_m + std::hypot(std::max(vehicle.front_m, vehicle.rear_m), vehicle.width_m);
  const auto first = [&](double at_m, double min_m) {
    return std::max(0, static_cast<int>((at_m - reach_m - min_m) / cell_m_));
  };
  const auto last = [&](double at_m, double min_m, int size) {
    return std::min(size - 1, static_cast<int>((at_m + reach_m - min_m) / cell_m_));
  };
  double nearest_m = kReach_m;
  for (int y = first(place.y_m, min_y_m_); y <= last(place.y_m, min_y_m_, size_y_); ++y)
    for (int x = first(place.x_m, min_x_m_); x <= last(place.x_m, min_x_m_, size_x_); ++x) {
      if (!is_obstacle(x, y)) continue;
      const Eigen::Vector2d middle(min_x_m_ + (x + 0.5) * cell_m_, min_y_m_ + (y + 0.5) * cell_m_);
      nearest_m = std::min(nearest_m, outside_m(vehicle, place, middle) - 0.5 * cell_m_);
    }
  for (const sim::Primitive& body : world_.walkers_at(time_s)) {
    const Disc disc = disc_around(body);
    nearest_m = std::min(nearest_m, outside_m(vehicle, place, disc.middle_m) - disc.radius_m);
  }
  return std::max(0.0, nearest_m);
}

bool TrueObstacles::is_obstacle(int x, int y) const {
  if (x < 0 || y < 0 || x >= size_x_ || y >= size_y_) return false;
  return is_obstacle_[static_cast<std::size_t>(y) * size_x_ + x] != 0;
}

std::vector<Edge> TrueObstacles::edges() const {
  std::vector<Edge> edges;
  const auto corner = [&](int x, int y) {
    return Eigen::Vector2d(min_x_m_ + x * cell_m_, min_y_m_ + y * cell_m_);
  };
  for (int y = 0; y <= size_y_; ++y)
    for (int x = 0; x <= size_x_; ++x) {
      if (is_obstacle(x, y) != is_obstacle(x - 1, y)) edges.emplace_back(corner(x, y), corner(x, y + 1));
      if (is_obstacle(x, y) != is_obstacle(x, y - 1)) edges.emplace_back(corner(x, y), corner(x + 1, y));
    }
  return edges;
}

std::vector<Edge> TrueObstacles::walker_edges(double time_s) const {
  constexpr int kCorners = 12;
  std::vector<Edge> edges;
  for (const sim::Primitive& body : world_.walkers_at(time_s)) {
    const Disc disc = disc_around(body);
    const auto corner = [&](int i) -> Eigen::Vector2d {
      const double angle = 2 * M_PI * i / kCorners;
      return disc.middle_m + disc.radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    };
    for (int i = 0; i < kCorners; ++i) edges.emplace_back(corner(i), corner(i + 1));
  }
  return edges;
}

}  // namespace gvom::driving
