#include "tools/drive/truth_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace gvom::driving {
namespace {

constexpr double kSteepest_rad = 0.48;  // that the truth calls drivable
constexpr double kSlopeReach_m = 0.4;   // to both sides
constexpr int kNeighbours[8][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};

bool may_be_driven_on(const sim::GroundTruth& truth, int x, int y) {
  return x >= 0 && y >= 0 && x < truth.size_x && y < truth.size_y &&
         truth.drivable[static_cast<std::size_t>(y) * truth.size_x + x] != 0;
}

/// Columns farther than `radius_m` from what cannot be driven on, between middles.
std::vector<std::uint8_t> grow(const sim::GroundTruth& truth, double radius_m) {
  std::vector<std::uint8_t> is_free = truth.drivable;
  const double radius = radius_m / truth.resolution_m;
  const int reach = static_cast<int>(radius);
  const auto block_around = [&](int x, int y) {
    for (int dy = std::max(-reach, -y); dy <= std::min(reach, truth.size_y - 1 - y); ++dy)
      for (int dx = std::max(-reach, -x); dx <= std::min(reach, truth.size_x - 1 - x); ++dx)
        if (dx * dx + dy * dy <= radius * radius)
          is_free[static_cast<std::size_t>(y + dy) * truth.size_x + x + dx] = 0;
  };
  for (int y = 0; y < truth.size_y; ++y)
    for (int x = 0; x < truth.size_x; ++x) {
      if (may_be_driven_on(truth, x, y)) continue;
      const bool is_border =
          std::any_of(std::begin(kNeighbours), std::end(kNeighbours),
                      [&](const int* step) { return may_be_driven_on(truth, x + step[0], y + step[1]); });
      if (is_border) block_around(x, y);
    }
  return is_free;
}

double slope_rad(const sim::GroundTruth& truth, int x, int y) {
  const int reach = std::max(1, static_cast<int>(std::lround(kSlopeReach_m / truth.resolution_m)));
  const auto height = [&](int px, int py) {
    return truth.ground_mean[static_cast<std::size_t>(py) * truth.size_x + px];
  };
  const int left = std::max(x - reach, 0), right = std::min(x + reach, truth.size_x - 1);
  const int low = std::max(y - reach, 0), high = std::min(y + reach, truth.size_y - 1);
  const double along_x = (height(right, y) - height(left, y)) / ((right - left) * truth.resolution_m);
  const double along_y = (height(x, high) - height(x, low)) / ((high - low) * truth.resolution_m);
  return std::atan(std::hypot(along_x, along_y));
}

}  // namespace

TruthPlanner::TruthPlanner(const sim::GroundTruth& truth, const TrueDriver& driver)
    : truth_(truth),
      driver_(driver),
      // `drivable` keeps a column's distance already.
      is_free_(grow(truth, std::max(0.0, 0.5 * driver.width_m - truth.resolution_m))),
      seconds_per_m_(is_free_.size()) {
  for (int y = 0; y < truth.size_y; ++y)
    for (int x = 0; x < truth.size_x; ++x) {
      const double steep = std::min(1.0, slope_rad(truth, x, y) / kSteepest_rad);
      seconds_per_m_[static_cast<std::size_t>(y) * truth.size_x + x] =
          static_cast<float>(1.0 / (driver.speed_mps * (1.0 - 0.5 * steep)));
    }
}

int TruthPlanner::column_at(const Eigen::Vector2d& point_m) const {
  const auto x = static_cast<std::int64_t>(std::floor(point_m.x() / truth_.resolution_m)) - truth_.origin[0];
  const auto y = static_cast<std::int64_t>(std::floor(point_m.y() / truth_.resolution_m)) - truth_.origin[1];
  if (x < 0 || y < 0 || x >= truth_.size_x || y >= truth_.size_y) return -1;
  return static_cast<int>(y * truth_.size_x + x);
}

Eigen::Vector2d TruthPlanner::middle_of(int column) const {
  const auto middle = [&](std::int64_t voxel) {
    return (static_cast<double>(voxel) + 0.5) * truth_.resolution_m;
  };
  return {middle(truth_.origin[0] + column % truth_.size_x),
          middle(truth_.origin[1] + column / truth_.size_x)};
}

bool TruthPlanner::is_free(const Eigen::Vector2d& point_m) const {
  const int column = column_at(point_m);
  return column >= 0 && is_free_[column] != 0;
}

std::optional<TruthPlanner::Leg> TruthPlanner::plan_leg(int from, const Eigen::Vector2d& to_m) const {
  std::vector<float> seconds(is_free_.size(), std::numeric_limits<float>::infinity());
  std::vector<int> before(is_free_.size(), -1);
  using Entry = std::pair<float, int>;  // equal times by column: one order everywhere
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  seconds[from] = 0;
  open.emplace(0.0F, from);
  while (!open.empty()) {
    const auto [time_s, column] = open.top();
    open.pop();
    if (time_s > seconds[column]) continue;
    if ((middle_of(column) - to_m).norm() <= driver_.goal_tolerance_m) {
      Leg leg{column, time_s, {}};
      for (int at = column; at != from; at = before[at]) leg.columns.push_back(at);
      std::reverse(leg.columns.begin(), leg.columns.end());
      return leg;
    }
    const int x = column % truth_.size_x, y = column / truth_.size_x;
    for (const auto& [dx, dy] : kNeighbours) {
      if (!may_be_driven_on(truth_, x + dx, y + dy)) continue;
      const int next = column + dy * truth_.size_x + dx;
      if (is_free_[next] == 0) continue;
      const double length_m = truth_.resolution_m * std::hypot(dx, dy);
      const auto there_s =
          static_cast<float>(time_s + 0.5 * length_m * (seconds_per_m_[column] + seconds_per_m_[next]));
      if (there_s >= seconds[next]) continue;
      seconds[next] = there_s;
      before[next] = column;
      open.emplace(there_s, next);
    }
  }
  return {};
}

std::optional<TrueWay> TruthPlanner::plan(const Eigen::Vector2d& start_m,
                                          const std::vector<Eigen::Vector2d>& waypoints_m) const {
  if (!is_free(start_m)) return {};
  TrueWay way;
  int at = column_at(start_m);
  way.points_m.push_back(middle_of(at));
  for (const Eigen::Vector2d& waypoint : waypoints_m) {
    const auto leg = plan_leg(at, waypoint);
    if (!leg) return {};
    way.seconds += leg->seconds;
    for (const int column : leg->columns) {
      way.length_m += (middle_of(column) - way.points_m.back()).norm();
      way.points_m.push_back(middle_of(column));
    }
    at = leg->end;
  }
  return way;
}

}  // namespace gvom::driving
