#include "tools/sim/terrain.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::sim {
namespace {

constexpr int kTopLevel = 4;
constexpr double kNudge = 1e-6;  // metres past a cell's border, to be surely in the next
constexpr double kNever = std::numeric_limits<double>::infinity();

/// The smaller distance at which the ray leaves the square that begins at (left, low), `edge` cells wide.
double exit_distance(const Eigen::Vector2d& start, const Eigen::Vector2d& inverse, double left, double low,
                     double edge) {
  const double x_border = inverse.x() > 0.0 ? left + edge : left;
  const double y_border = inverse.y() > 0.0 ? low + edge : low;
  return std::min((x_border - start.x()) * inverse.x(), (y_border - start.y()) * inverse.y());
}

double safe_inverse(double value) {
  return 1.0 / (std::abs(value) < 1e-12 ? 1e-12 : value);
}

}  // namespace

Terrain::Terrain(const GroundMap& map)
    : map_(map),
      cell_m_(map.resolution_m),
      cells_per_m_(1.0 / map.resolution_m),
      width_(map.nodes_x - 1),
      height_(map.nodes_y - 1) {
  build_maxima();
}

Area Terrain::area() const {
  return {map_.min_x_m, map_.min_y_m, map_.min_x_m + width_ * cell_m_, map_.min_y_m + height_ * cell_m_};
}

void Terrain::build_maxima() {
  levels_.reserve(kTopLevel);
  const std::vector<float>* finer = &map_.height_m;
  int finer_width = width_ + 1, finer_height = height_ + 1;
  for (int level = 1; level <= kTopLevel; ++level) {
    const int edge = 1 << 2 * level;
    Maxima coarser{(width_ + edge - 1) / edge, (height_ + edge - 1) / edge, {}};
    // Level 1 shares the nodes on its borders with its neighbours; higher levels hold whole squares.
    const int span = level == 1 ? 5 : 4;
    for (int iy = 0; iy < coarser.height; ++iy)
      for (int ix = 0; ix < coarser.width; ++ix) {
        float highest = -std::numeric_limits<float>::infinity();
        for (int y = 4 * iy; y < std::min(4 * iy + span, finer_height); ++y) {
          const auto row = finer->begin() + static_cast<std::ptrdiff_t>(y) * finer_width;
          highest =
              std::max(highest, *std::max_element(row + 4 * ix, row + std::min(4 * ix + span, finer_width)));
        }
        coarser.highest_m.push_back(highest);
      }
    levels_.push_back(std::move(coarser));
    finer = &levels_.back().highest_m;
    finer_width = levels_.back().width;
    finer_height = levels_.back().height;
  }
}

double Terrain::patch_height(int ix, int iy, double cell_x, double cell_y) const {
  const float* low = node(ix, iy);
  const float* high = low + width_ + 1;
  const double fx = cell_x - ix;
  const double near_side = low[0] + fx * (low[1] - low[0]);
  const double far_side = high[0] + fx * (high[1] - high[0]);
  return near_side + (cell_y - iy) * (far_side - near_side);
}

Terrain::Place Terrain::place(double x_m, double y_m) const {
  const double x = std::clamp((x_m - map_.min_x_m) * cells_per_m_, 0.0, static_cast<double>(width_));
  const double y = std::clamp((y_m - map_.min_y_m) * cells_per_m_, 0.0, static_cast<double>(height_));
  const int ix = std::min(static_cast<int>(x), width_ - 1);
  const int iy = std::min(static_cast<int>(y), height_ - 1);
  return {ix, iy, x - ix, y - iy};
}

double Terrain::height_m(double x_m, double y_m) const {
  const Place at = place(x_m, y_m);
  return patch_height(at.ix, at.iy, at.ix + at.fx, at.iy + at.fy);
}

Surface Terrain::surface_at(double x_m, double y_m) const {
  if (map_.surface.empty()) return Surface::ground;
  const Place at = place(x_m, y_m);
  const int ix = at.ix + (at.fx < 0.5 ? 0 : 1);
  const int iy = at.iy + (at.fy < 0.5 ? 0 : 1);
  return map_.surface[static_cast<std::size_t>(iy) * (width_ + 1) + ix];
}

bool Terrain::is_sound(double x_m, double y_m) const {
  if (map_.surface.empty()) return true;
  const Place at = place(x_m, y_m);
  const Surface* low = map_.surface.data() + static_cast<std::size_t>(at.iy) * (width_ + 1) + at.ix;
  const Surface* high = low + width_ + 1;
  const auto is_sound = [](Surface surface) { return surface != Surface::hole && surface != Surface::face; };
  return is_sound(low[0]) && is_sound(low[1]) && is_sound(high[0]) && is_sound(high[1]);
}

Eigen::Vector3d Terrain::normal_at(double x_m, double y_m) const {
  const Place at = place(x_m, y_m);
  const float* low = node(at.ix, at.iy);
  const float* high = low + width_ + 1;
  const double along_x = (1.0 - at.fy) * (low[1] - low[0]) + at.fy * (high[1] - high[0]);
  const double along_y = (1.0 - at.fx) * (high[0] - low[0]) + at.fx * (high[1] - low[1]);
  return Eigen::Vector3d(-along_x * cells_per_m_, -along_y * cells_per_m_, 1.0).normalized();
}

double Terrain::hit_in_cell(int ix, int iy, const Ray& ray, const Interval& part) const {
  const auto above_ground = [&](double distance) {
    const Eigen::Vector3d point = ray.origin + distance * ray.direction;
    return point.z() - patch_height(ix, iy, (point.x() - map_.min_x_m) * cells_per_m_,
                                    (point.y() - map_.min_y_m) * cells_per_m_);
  };
  const double begin = above_ground(part.enter);
  if (begin <= 0.0) return part.enter;
  const double end = above_ground(part.leave);
  if (end > 0.0) return kNever;
  // Along a straight line the bilinear patch is a parabola: three values give it exactly.
  const double middle = above_ground(0.5 * (part.enter + part.leave));
  const double a = 2.0 * (begin + end - 2.0 * middle);
  const double b = 4.0 * middle - 3.0 * begin - end;
  const double root = std::sqrt(std::max(0.0, b * b - 4.0 * a * begin));
  const double q = -0.5 * (b + std::copysign(root, b));
  const double first = q / a;
  const double at = first >= 0.0 && first <= 1.0 ? first : begin / q;
  return part.enter + std::clamp(at, 0.0, 1.0) * (part.leave - part.enter);
}

double Terrain::intersect(const Ray& ray, double max_range_m) const {
  const Eigen::Vector2d start((ray.origin.x() - map_.min_x_m) * cells_per_m_,
                              (ray.origin.y() - map_.min_y_m) * cells_per_m_);
  const Eigen::Vector2d step = ray.direction.head<2>() * cells_per_m_;
  const Eigen::Vector2d inverse(safe_inverse(step.x()), safe_inverse(step.y()));
  int level = kTopLevel;
  double distance = 0.0;
  while (distance < max_range_m) {
    const double ahead = distance + kNudge;
    const int ix = static_cast<int>(std::floor(start.x() + ahead * step.x()));
    const int iy = static_cast<int>(std::floor(start.y() + ahead * step.y()));
    if (ix < 0 || iy < 0 || ix >= width_ || iy >= height_) return kNever;

    const int shift = 2 * level;
    const int edge = 1 << shift;
    const double leave = std::min(
        max_range_m, exit_distance(start, inverse, ix >> shift << shift, iy >> shift << shift, edge));
    if (level == 0) {
      const double hit = hit_in_cell(ix, iy, ray, {distance, leave});
      if (hit < kNever) return hit;
    } else {
      const Maxima& maxima = levels_[level - 1];
      const double lowest = ray.origin.z() + ray.direction.z() * (ray.direction.z() < 0.0 ? leave : distance);
      if (lowest <= maxima.highest_m[static_cast<std::size_t>(iy >> shift) * maxima.width + (ix >> shift)]) {
        --level;
        continue;
      }
    }
    distance = std::max(leave, ahead);
    level = std::min(level + 1, kTopLevel);
  }
  return kNever;
}

}  // namespace gvom::sim
