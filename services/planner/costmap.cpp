#include "services/planner/costmap.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::planner {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr double kHeadroom_m = 0.1;

std::size_t square(int n) {
  return static_cast<std::size_t>(n) * n;
}

// value / full, within 0 .. 1; NaN is 0, as in R16.
float share(float value, float full) {
  const float positive = value > 0 ? value : 0;
  return std::min(positive / full, 1.0F);
}

}  // namespace

Costmap::Costmap(const CostmapConfig& config, const VehicleLimits& vehicle, int n_xy)
    : config_(config),
      vehicle_(vehicle),
      half_length_m_(vehicle.length_m() / 2 + config.margin_m),
      half_width_m_(vehicle.width_m / 2 + config.margin_m),
      cost_(square(n_xy)),
      smooth_(square(n_xy)),
      distance_m_(square(n_xy)),
      soft_m_(square(n_xy)),
      ground_m_(square(n_xy)),
      lethal_(square(n_xy)),
      known_(square(n_xy)),
      soft_(square(n_xy)),
      open_(square(n_xy)),
      marked_(square(n_xy + 2)),
      bridging_(n_xy),
      transform_(n_xy) {}

void Costmap::update(const MapView& map) {
  cells_ = map.cells();
  find_lethal(map);
  transform_.run(lethal_.data(), cells_.n, cells_.cell_m, distance_m_.data());
  find_soft(map);
  find_known(map);
  weigh(map);
}

// The paper filters single pixels, "assuming they are noise". A single HARD column may be a trunk.
void Costmap::find_lethal(const MapView& map) {
  const int n = cells_.n, wide = n + 2;
  const auto lowest = static_cast<float>(vehicle_.height_m + kHeadroom_m);
  std::fill_n(marked_.begin(), square(wide), std::uint8_t{0});
  for (int y = 0; y < n; ++y) {
    std::uint8_t* const marked = marked_.data() + (y + 1) * wide + 1;
    std::uint8_t* const lethal = lethal_.data() + y * n;
    const std::uint8_t* const flags = map.flags + y * n;
    const float* const clearance = map.clearance + y * n;
    for (int x = 0; x < n; ++x) {
      const bool stands = (flags[x] & kHard) != 0, hangs = clearance[x] < lowest;
      const bool ground = (flags[x] & (kSteep | kNegative)) != 0;
      lethal[x] = stands | hangs;
      marked[x] = stands | hangs | ground;
    }
  }
  for (int y = 0; y < n; ++y) {
    const std::uint8_t* const above = marked_.data() + y * wide;
    const std::uint8_t* const here = above + wide;
    const std::uint8_t* const below = here + wide;
    std::uint8_t* const lethal = lethal_.data() + y * n;
    for (int x = 0; x < n; ++x) {
      const int marks = above[x] + above[x + 1] + above[x + 2] + here[x] + here[x + 2] + below[x] +
                        below[x + 1] + below[x + 2];
      lethal[x] = lethal[x] | (here[x + 1] & (marks > 0));
    }
  }
}

void Costmap::find_soft(const MapView& map) {
  for (int i = 0; i < cells_.count(); ++i) soft_[i] = (map.flags[i] & kSoft) != 0;
  transform_.run(soft_.data(), cells_.n, cells_.cell_m, soft_m_.data());
}

void Costmap::find_known(const MapView& map) {
  constexpr auto kLeast = static_cast<std::uint8_t>(Visibility::ground_assumed);
  for (int i = 0; i < cells_.count(); ++i) {
    ground_m_[i] = map.visibility[i] >= kLeast ? map.height[i] : kUnknown;
    const bool known = ground_m_[i] == ground_m_[i];
    known_[i] = known;
    open_[i] = !known & !(map.flags[i] & kNegative);
  }
  const double drivable = std::tan(std::min(vehicle_.max_pitch_rad, vehicle_.max_roll_rad));
  constexpr int kWays[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
  for (const auto& [dx, dy] : kWays) {
    const double step_m = cells_.cell_m * std::hypot(dx, dy);
    const int longest = std::min(static_cast<int>(config_.gap_m / step_m + 1e-9), cells_.n - 2);
    for (int gap = 1; gap <= longest; ++gap) bridge(dx, dy, gap, drivable * step_m * (gap + 1));
  }
}

void Costmap::bridge(int dx, int dy, int gap, double rise_m) {
  const int n = cells_.n, stride = dy * n + dx, over = gap + 1;
  const int first = std::max(0, -dx * over), end = n - std::max(0, dx * over);
  const int lowest = dy < 0 ? over : 0, highest = dy > 0 ? n - over : n;
  const auto rise = static_cast<float>(rise_m);
  std::uint8_t* const bridging = bridging_.data();
  for (int y = lowest; y < highest; ++y) {
    const float* const near = ground_m_.data() + y * n;
    const float* const far = near + over * stride;
    for (int x = first; x < end; ++x) bridging[x] = std::fabs(near[x] - far[x]) <= rise;
    for (int k = 1; k <= gap; ++k) {
      const std::uint8_t* const open = open_.data() + y * n + k * stride;
      for (int x = first; x < end; ++x) bridging[x] &= open[x];
    }
    for (int k = 1; k <= gap; ++k) {
      std::uint8_t* const known = known_.data() + y * n + k * stride;
      for (int x = first; x < end; ++x) known[x] |= bridging[x];
    }
  }
}

void Costmap::weigh(const MapView& map) {
  const auto slope_weight = static_cast<float>(config_.slope_weight);
  const auto slope_full = static_cast<float>(config_.slope_full_rad);
  const auto roughness_weight = static_cast<float>(config_.roughness_weight);
  const auto roughness_full = static_cast<float>(config_.roughness_full_m2);
  const auto soft_weight = static_cast<float>(config_.soft_weight);
  const auto unknown_cost = static_cast<float>(config_.unknown_cost);
  const auto remembered_cost = static_cast<float>(config_.remembered_cost);
  const auto near_weight = static_cast<float>(config_.near_weight);
  const auto near_m = static_cast<float>(config_.near_m);
  const auto reach_m = static_cast<float>(half_width_m_), most = static_cast<float>(kMostCost);
  const int n = cells_.n;
  for (int y = 0; y < n; ++y) {
    const int row = y * n;
    const std::uint8_t* const marked = marked_.data() + (y + 1) * (n + 2) + 1;
    const float* const from_soft = soft_m_.data() + row;
    const std::uint8_t* const visibility = map.visibility + row;
    const std::uint8_t* const known = known_.data() + row;
    const float* const distance = distance_m_.data() + row;
    float* const cost = cost_.data() + row;
    float* const smooth = smooth_.data() + row;
    for (int x = 0; x < n; ++x) {
      const float over = marked[x] ? 1 : 1 - from_soft[x] / reach_m;  // marked and lethal: has no use for it
      float sum = 1 + slope_weight * share(map.slope[row + x], slope_full) +
                  roughness_weight * share(map.roughness[row + x], roughness_full);
      sum += soft_weight * (over > 0 ? over : 0);
      sum += known[x] ? 0 : unknown_cost;
      sum += is_remembered(visibility[x]) ? remembered_cost : 0;
      const float off = 1 - (distance[x] - reach_m) / near_m;
      sum += near_weight * (off > 0 ? off : 0);
      cost[x] = distance[x] < reach_m ? kLethalCost : sum;
      smooth[x] = std::min(distance[x] < reach_m ? most * (1 - distance[x] / (2 * reach_m)) : sum, most);
    }
  }
}

CostSample Costmap::sample(double x_m, double y_m) const {
  const double last = cells_.n - 1;
  const double px = (x_m - cells_.x_m) / cells_.cell_m - 0.5, py = (y_m - cells_.y_m) / cells_.cell_m - 0.5;
  const double x = std::clamp(px, 0.0, last), y = std::clamp(py, 0.0, last);
  const int x0 = std::min(static_cast<int>(x), cells_.n - 2),
            y0 = std::min(static_cast<int>(y), cells_.n - 2);
  const double fx = x - x0, fy = y - y0;
  const float* const corner = smooth_.data() + y0 * cells_.n + x0;
  const double a = corner[0], b = corner[1], c = corner[cells_.n], d = corner[cells_.n + 1];
  const double low = a + fx * (b - a), high = c + fx * (d - c);
  const double dx = (1 - fy) * (b - a) + fy * (d - c);
  return {low + fy * (high - low),
          {px == x ? dx / cells_.cell_m : 0, py == y ? (high - low) / cells_.cell_m : 0}};
}

bool Costmap::fits(const Pose2& pose) const {
  const Eigen::Vector2d forward = pose.forward();
  const Eigen::Vector2d middle = pose.place() + forward * ((vehicle_.front_m - vehicle_.rear_m) / 2);
  const int cell = cells_.index_of(middle.x(), middle.y());
  if (cell >= 0) {
    const double to_middle_m = cells_.cell_m * std::sqrt(0.5);  // the cell's, at most
    if (distance_m_[cell] > std::hypot(half_length_m_, half_width_m_) + to_middle_m) return true;
    if (distance_m_[cell] + to_middle_m < std::min(half_length_m_, half_width_m_)) return false;
  }
  return !holds_lethal(middle, forward);
}

bool Costmap::holds_lethal(const Eigen::Vector2d& middle, const Eigen::Vector2d& forward) const {
  const double cos = forward.x(), sin = forward.y();
  const double reach_x = std::fabs(cos) * half_length_m_ + std::fabs(sin) * half_width_m_;
  const double reach_y = std::fabs(sin) * half_length_m_ + std::fabs(cos) * half_width_m_;
  const auto bound = [&](double m, double corner_m) {
    return static_cast<int>(std::clamp(std::floor((m - corner_m) / cells_.cell_m), -1.0, 1.0 * cells_.n));
  };
  const int x0 = std::max(bound(middle.x() - reach_x, cells_.x_m), 0);
  const int y0 = std::max(bound(middle.y() - reach_y, cells_.y_m), 0);
  const int x1 = std::min(bound(middle.x() + reach_x, cells_.x_m), cells_.n - 1);
  const int y1 = std::min(bound(middle.y() + reach_y, cells_.y_m), cells_.n - 1);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      if (!lethal_[y * cells_.n + x]) continue;
      const Eigen::Vector2d off = cells_.center_of(y * cells_.n + x) - middle;
      const double ahead = off.x() * cos + off.y() * sin, aside = off.y() * cos - off.x() * sin;
      if (std::fabs(ahead) <= half_length_m_ && std::fabs(aside) <= half_width_m_) return true;
    }
  }
  return false;
}

}  // namespace gvom::planner
