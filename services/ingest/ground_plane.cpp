#include "services/ingest/ground_plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/returns.hpp"

namespace gvom::ingest {

namespace {

constexpr double kNearest_m = 3, kFarthest_m = 15, kRing_m = 1.5;
constexpr int kRings = 8, kSectors = 24, kCells = kRings * kSectors;
constexpr int kLeastOnPlane = 16;
constexpr int kLeastRings = 3;           // of one, a round wall's foot could be the ground
constexpr double kLeastShare = 0.5;      // of the cells
constexpr double kNear_m = 0.15;         // so far from the plane a cell's lowest return is of the ground
constexpr double kLeastVariance_m2 = 2;  // of where these lie, in the direction in which they spread least
constexpr int kTrials = 300;

struct Point {
  double x_m, y_m, z_m;
  int ring;
};

/// The lowest return of each cell around base_link; `count` have one.
struct LowestReturns {
  std::array<Point, kCells> points;
  int count = 0;
};

int cell_of(double x_m, double y_m) {
  const double range_m = std::sqrt(x_m * x_m + y_m * y_m);
  if (!(range_m >= kNearest_m && range_m < kFarthest_m)) return -1;
  const double turn = std::atan2(y_m, x_m) / (2 * M_PI) + 0.5;
  const int sector = std::min(static_cast<int>(turn * kSectors), kSectors - 1);
  return sector * kRings + static_cast<int>((range_m - kNearest_m) / kRing_m);
}

LowestReturns lowest_returns(const Sweep& sweep, const ReturnFilter& filter) {
  std::array<Point, kCells> lowest;
  lowest.fill({0, 0, INFINITY, 0});
  for (const Return& r : sweep.returns) {
    if (filter.judge(r) != Verdict::used) continue;
    const auto coordinate = [&](int axis) {
      return filter.T_base_sensor.coordinate(axis, r.x_m, r.y_m, r.z_m);
    };
    Point p{coordinate(0), coordinate(1), coordinate(2), 0};
    const int cell = cell_of(p.x_m, p.y_m);
    p.ring = cell % kRings;
    if (cell >= 0 && p.z_m < lowest[cell].z_m) lowest[cell] = p;
  }
  LowestReturns found;
  for (const Point& p : lowest)
    if (p.z_m < INFINITY) found.points[found.count++] = p;
  return found;
}

double above(const GroundPlane& plane, const Point& p) {
  return p.z_m - (plane.height_m + plane.slope_x * p.x_m + plane.slope_y * p.y_m);
}

std::optional<GroundPlane> plane_through(const Point& a, const Point& b, const Point& c) {
  const double bx = b.x_m - a.x_m, by = b.y_m - a.y_m, bz = b.z_m - a.z_m;
  const double cx = c.x_m - a.x_m, cy = c.y_m - a.y_m, cz = c.z_m - a.z_m;
  const double area = bx * cy - by * cx;
  if (std::abs(area) < 10) return std::nullopt;  // twice the triangle's, m^2
  const double slope_x = (bz * cy - by * cz) / area, slope_y = (bx * cz - bz * cx) / area;
  if (slope_x * slope_x + slope_y * slope_y > 4) return std::nullopt;  // 63 degrees: a wall
  return GroundPlane{a.z_m - slope_x * a.x_m - slope_y * a.y_m, slope_x, slope_y};
}

/// How many lie on the plane, less those below it: there is nothing under the ground.
int score(const GroundPlane& plane, const LowestReturns& lowest) {
  int on = 0, below = 0;
  for (int i = 0; i < lowest.count; ++i) {
    const double z_m = above(plane, lowest.points[i]);
    on += std::abs(z_m) <= kNear_m ? 1 : 0;
    below += z_m < -2 * kNear_m ? 1 : 0;
  }
  return on - below;
}

/// Of planes through three cells, drawn by a fixed sequence, the one with the highest score.
std::optional<GroundPlane> best_of_trials(const LowestReturns& lowest) {
  std::minstd_rand draw(1);
  std::optional<GroundPlane> best;
  int best_score = 0;
  for (int i = 0; i < kTrials; ++i) {
    std::array<const Point*, 3> three{};
    for (const Point*& p : three) p = &lowest.points[draw() % static_cast<unsigned>(lowest.count)];
    const auto plane = plane_through(*three[0], *three[1], *three[2]);
    if (!plane) continue;
    const int its_score = score(*plane, lowest);
    if (its_score <= best_score) continue;
    best = plane;
    best_score = its_score;
  }
  return best;
}

/// Least squares over the cells on `rough`; nothing if those are too few or lie too much in a line.
std::optional<GroundPlane> refine(const GroundPlane& rough, const LowestReturns& lowest) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int n = 0;
  unsigned rings = 0;
  for (int i = 0; i < lowest.count; ++i) {
    const Point& p = lowest.points[i];
    if (std::abs(above(rough, p)) > kNear_m) continue;
    const Eigen::Vector3d v(p.x_m, p.y_m, p.z_m);
    mean += v;
    squares += v * v.transpose();
    rings |= 1u << p.ring;
    ++n;
  }
  const bool enough = n >= kLeastOnPlane && n >= kLeastShare * lowest.count;
  if (!enough || __builtin_popcount(rings) < kLeastRings) return std::nullopt;
  mean /= n;
  const Eigen::Matrix3d covariance = squares / n - mean * mean.transpose();
  const double xx = covariance(0, 0), xy = covariance(0, 1), yy = covariance(1, 1);
  const double determinant = xx * yy - xy * xy;
  const double least = (xx + yy) / 2 - std::sqrt((xx - yy) * (xx - yy) / 4 + xy * xy);
  if (least < kLeastVariance_m2) return std::nullopt;
  const double a = (yy * covariance(0, 2) - xy * covariance(1, 2)) / determinant;
  const double b = (xx * covariance(1, 2) - xy * covariance(0, 2)) / determinant;
  return GroundPlane{mean.z() - a * mean.x() - b * mean.y(), a, b};
}

}  // namespace

std::optional<GroundPlane> find_ground(const Sweep& sweep, const LidarGeometry& lidar,
                                       const VehicleGeometry& vehicle) {
  const LowestReturns lowest = lowest_returns(sweep, ReturnFilter(lidar, vehicle));
  if (lowest.count < kLeastOnPlane) return std::nullopt;
  const auto rough = best_of_trials(lowest);
  const auto better = rough ? refine(*rough, lowest) : std::nullopt;
  return better ? refine(*better, lowest) : std::nullopt;
}

}  // namespace gvom::ingest
