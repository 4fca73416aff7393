#include "tools/sim/terrain.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::sim {
namespace {

constexpr double kCellsPerMetre = 10.0;
constexpr double kCell = 1.0 / kCellsPerMetre;
constexpr int kTopLevel = 4;
constexpr int kBlock = 1 << 2 * kTopLevel;  // cells along an edge of the coarsest square
constexpr double kNudge = 1e-6;             // metres past a cell's border, to be surely in the next
constexpr double kNever = std::numeric_limits<double>::infinity();

int cells_of(double length_m) {
  return static_cast<int>(std::ceil(length_m * kCellsPerMetre / kBlock)) * kBlock;
}

/// Adds the waves along one row of nodes; sin(a + b) from tables of a, so no sine per node.
struct WaveTables {
  WaveTables(const std::vector<Wave>& the_waves, double min_x_m, int count) : waves(the_waves) {
    for (const Wave& wave : waves) {
      std::vector<double> sine(count), cosine(count);
      for (int i = 0; i < count; ++i) {
        const double angle = wave.kx * (min_x_m + i * kCell);
        sine[i] = wave.amplitude_m * std::sin(angle);
        cosine[i] = wave.amplitude_m * std::cos(angle);
      }
      sines.push_back(std::move(sine));
      cosines.push_back(std::move(cosine));
    }
  }

  void add_row(double y_m, std::vector<double>& row) const {
    for (std::size_t w = 0; w < waves.size(); ++w) {
      const double sine = std::sin(waves[w].ky * y_m + waves[w].phase);
      const double cosine = std::cos(waves[w].ky * y_m + waves[w].phase);
      for (std::size_t i = 0; i < row.size(); ++i) row[i] += sines[w][i] * cosine + cosines[w][i] * sine;
    }
  }

  const std::vector<Wave>& waves;
  std::vector<std::vector<double>> sines;
  std::vector<std::vector<double>> cosines;
};

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

Terrain::Terrain(const Landscape& landscape, const Area& area)
    : min_x_m_(area.min_x_m),
      min_y_m_(area.min_y_m),
      width_(cells_of(area.max_x_m - area.min_x_m)),
      height_(cells_of(area.max_y_m - area.min_y_m)) {
  fill(landscape);
  build_maxima();
}

void Terrain::fill(const Landscape& landscape) {
  const int columns = width_ + 1;
  nodes_.resize(static_cast<std::size_t>(columns) * (height_ + 1));
  const WaveTables waves(landscape.waves(), min_x_m_, columns);
  const WaveTables ripples(landscape.ripples(), min_x_m_, columns);
  std::vector<double> trail_y(columns);
  for (int i = 0; i < columns; ++i) trail_y[i] = landscape.trail_y_m(min_x_m_ + i * kCell);

  std::vector<double> row(columns);
  for (int iy = 0; iy <= height_; ++iy) {
    const double y = min_y_m_ + iy * kCell;
    std::fill(row.begin(), row.end(), 0.0);
    waves.add_row(y, row);
    for (int i = 0; i < columns; ++i) row[i] *= Landscape::trail_factor(y - trail_y[i]);
    ripples.add_row(y, row);
    for (int i = 0; i < columns; ++i) {
      const double x = min_x_m_ + i * kCell;
      const double features = landscape.step_height_m(x, y) - landscape.ditch_depth_m(x, y);
      nodes_[static_cast<std::size_t>(iy) * columns + i] = static_cast<float>(row[i] + features);
    }
  }
}

void Terrain::build_maxima() {
  Maxima finer{width_ + 1, nodes_};
  for (int level = 1; level <= kTopLevel; ++level) {
    Maxima coarser{width_ >> 2 * level, {}};
    const int rows = height_ >> 2 * level;
    // Level 1 shares the nodes on its borders with its neighbours; higher levels hold whole squares.
    const int span = level == 1 ? 5 : 4;
    for (int iy = 0; iy < rows; ++iy)
      for (int ix = 0; ix < coarser.width; ++ix) {
        float highest = -std::numeric_limits<float>::infinity();
        for (int y = 4 * iy; y < 4 * iy + span; ++y) {
          const auto begin = finer.highest_m.begin() + static_cast<std::ptrdiff_t>(y) * finer.width + 4 * ix;
          highest = std::max(highest, *std::max_element(begin, begin + span));
        }
        coarser.highest_m.push_back(highest);
      }
    levels_.push_back(coarser);
    finer = std::move(coarser);
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

double Terrain::height_m(double x_m, double y_m) const {
  const double cell_x = std::clamp((x_m - min_x_m_) * kCellsPerMetre, 0.0, static_cast<double>(width_));
  const double cell_y = std::clamp((y_m - min_y_m_) * kCellsPerMetre, 0.0, static_cast<double>(height_));
  const int ix = std::min(static_cast<int>(cell_x), width_ - 1);
  const int iy = std::min(static_cast<int>(cell_y), height_ - 1);
  return patch_height(ix, iy, cell_x, cell_y);
}

double Terrain::hit_in_cell(int ix, int iy, const Ray& ray, const Interval& part) const {
  const auto above_ground = [&](double distance) {
    const Eigen::Vector3d point = ray.origin + distance * ray.direction;
    return point.z() - patch_height(ix, iy, (point.x() - min_x_m_) * kCellsPerMetre,
                                    (point.y() - min_y_m_) * kCellsPerMetre);
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
  const Eigen::Vector2d start((ray.origin.x() - min_x_m_) * kCellsPerMetre,
                              (ray.origin.y() - min_y_m_) * kCellsPerMetre);
  const Eigen::Vector2d step = ray.direction.head<2>() * kCellsPerMetre;
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
