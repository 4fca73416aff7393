#include "tools/sim/scenes/course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gvom::sim {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr double kSwingLength = 60.0;
constexpr double kCornerSpacing = 4.0;

}  // namespace

Course straight_course(double length_m) {
  return {{{0.0, 0.0}, {length_m, 0.0}}, {{-kAround, 0.0}, {length_m + kAround, 0.0}}};
}

Course winding_course(double length_m, double swing_m) {
  Course course;
  const int first = -static_cast<int>(std::ceil(kAround / kCornerSpacing));
  const int end = static_cast<int>(std::ceil(length_m / kCornerSpacing));
  const int last = static_cast<int>(std::ceil((length_m + kAround) / kCornerSpacing));
  for (int i = first; i <= last; ++i) {
    const double x = i * kCornerSpacing;
    const Eigen::Vector2d corner(x, quantised(swing_m * std::sin(kTurn / kSwingLength * x)));
    course.trail_m.push_back(corner);
    if (i >= 0 && i <= end) course.path_m.push_back(corner);
  }
  return course;
}

double distance_to(const std::vector<Eigen::Vector2d>& line_m, const Eigen::Vector2d& point_m) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < line_m.size(); ++i) {
    const Eigen::Vector2d along = line_m[i + 1] - line_m[i];
    const double at = std::clamp((point_m - line_m[i]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (point_m - line_m[i] - at * along).norm());
  }
  return nearest;
}

double y_on(const std::vector<Eigen::Vector2d>& line_m, double x_m) {
  std::size_t next = 1;
  while (next + 1 < line_m.size() && line_m[next].x() < x_m) ++next;
  const Eigen::Vector2d& before = line_m[next - 1];
  const Eigen::Vector2d& after = line_m[next];
  return before.y() + (x_m - before.x()) / (after.x() - before.x()) * (after.y() - before.y());
}

double quantised(double length_m) {
  return std::round(length_m * 4096.0) / 4096.0;
}

}  // namespace gvom::sim
