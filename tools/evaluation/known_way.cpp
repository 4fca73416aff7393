#include "tools/evaluation/known_way.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

namespace gvom::evaluation {
namespace {

using Voxel = KnownColumns::Voxel;

constexpr double kTrafficLow_m = 0.3;
constexpr double kTrafficHigh_m = 4.0;
constexpr double kTrafficRoom_m = 1.0;

/// Calls `visit` for the columns whose middle may be within `reach_m` of the line between two points.
template <typename Visit>
void for_each_around(const KnownColumns& known, const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m,
                     double reach_m, Visit&& visit) {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(reach_m);
  const Eigen::Vector2d low_m = from_m.cwiseMin(to_m) - reach, high_m = from_m.cwiseMax(to_m) + reach;
  const Voxel low = known.voxel_of(low_m.x(), low_m.y()), high = known.voxel_of(high_m.x(), high_m.y());
  for (std::int64_t y = low[1]; y <= high[1]; ++y)
    for (std::int64_t x = low[0]; x <= high[0]; ++x) visit(Voxel{x, y});
}

/// Of a point from the polyline, seen from above.
double distance_m(const Way& way_m, const Eigen::Vector2d& point_m) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < way_m.size(); ++i) {
    const Eigen::Vector2d from_m = way_m[i].head<2>();
    const Eigen::Vector2d step_m = way_m[i + 1].head<2>() - from_m;
    const double along = step_m.squaredNorm() > 0.0
                             ? std::clamp((point_m - from_m).dot(step_m) / step_m.squaredNorm(), 0.0, 1.0)
                             : 0.0;
    nearest = std::min(nearest, (point_m - from_m - along * step_m).norm());
  }
  return nearest;
}

double height_near(const Way& way_m, const Eigen::Vector2d& point_m) {
  const auto nearest = std::min_element(way_m.begin(), way_m.end(), [&](const auto& a, const auto& b) {
    return (a.template head<2>() - point_m).squaredNorm() < (b.template head<2>() - point_m).squaredNorm();
  });
  return nearest->z();
}

}  // namespace

KnownColumns know_by_way(const Way& way_m, double half_width_m, double edge_m) {
  KnownColumns known(edge_m);
  std::set<Voxel> asked;
  for (std::size_t i = 0; i + 1 < way_m.size(); ++i)
    for_each_around(known, way_m[i].head<2>(), way_m[i + 1].head<2>(), half_width_m, [&](const Voxel& voxel) {
      if (!asked.insert(voxel).second) return;
      if (distance_m(way_m, known.middle_of(voxel)) <= half_width_m) known.set(voxel, Known::drivable);
    });
  return known;
}

void forget_traffic(KnownColumns& known, const Way& way_m, const std::vector<Eigen::Vector3d>& returns_m) {
  std::set<Voxel> taken;
  for (const Eigen::Vector3d& at_m : returns_m) {
    const Voxel voxel = known.voxel_of(at_m.x(), at_m.y());
    if (known.at(voxel) != Known::drivable || taken.count(voxel) > 0) continue;
    const double above_m = at_m.z() - height_near(way_m, at_m.head<2>());
    if (above_m > kTrafficLow_m && above_m < kTrafficHigh_m) taken.insert(voxel);
  }
  for (const Voxel& voxel : taken) {
    const Eigen::Vector2d middle_m = known.middle_of(voxel);
    for_each_around(known, middle_m, middle_m, kTrafficRoom_m, [&](const Voxel& beside) {
      if ((known.middle_of(beside) - middle_m).norm() <= kTrafficRoom_m) known.set(beside, Known::nothing);
    });
  }
}

}  // namespace gvom::evaluation
