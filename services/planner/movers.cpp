#include "services/planner/movers.hpp"

#include <algorithm>

#include "services/planner/disc.hpp"

namespace gvom::planner {
namespace {

constexpr std::uint8_t kNotOpen = kHard | kSoft | kNegative | kSteep;
constexpr double kBeside_m = 0.4;   // an edge may have been so far off
constexpr double kCluster_m = 1.2;  // cells so near to each other are of one thing
constexpr double kLeastSpeed_mps = 1;

}  // namespace

Movers::Movers(int n_xy) : flags_(static_cast<std::size_t>(n_xy) * static_cast<std::size_t>(n_xy)) {
  for (Past& past : pasts_) past.is_open.resize(flags_.size());
  movers_.reserve(kMost);
}

void Movers::clear() {
  taken_ = 0;
  movers_.clear();
}

void Movers::remember(const MapView& map) {
  constexpr auto kLeast = static_cast<std::uint8_t>(Visibility::ground_assumed);
  Past& now = pasts_[taken_++ % kPasts];
  now.stamp_ns = map.stamp_ns;
  now.cells = map.cells();
  for (int i = 0; i < now.cells.count(); ++i) {
    const bool ground = map.visibility[i] >= kLeast && map.height[i] == map.height[i];
    now.is_open[static_cast<std::size_t>(i)] = ground && (map.flags[i] & kNotOpen) == 0 ? 1 : 0;
  }
}

const Movers::Past* Movers::past(std::int64_t stamp_ns) const {
  for (std::size_t back = 1; back <= std::min(taken_, kPasts); ++back) {
    const Past& past = pasts_[(taken_ - back) % kPasts];
    if (past.stamp_ns <= stamp_ns) return &past;
  }
  return nullptr;
}

bool Movers::was_open(const Past& past, const Eigen::Vector2d& place_m) {
  const int cell = past.cells.index_of(place_m.x(), place_m.y());
  if (cell < 0) return false;
  const int n = past.cells.n, reach = static_cast<int>(std::lround(kBeside_m / past.cells.cell_m));
  for (int y = std::max(0, cell / n - reach); y <= std::min(n - 1, cell / n + reach); ++y)
    for (int x = std::max(0, cell % n - reach); x <= std::min(n - 1, cell % n + reach); ++x)
      if (past.is_open[static_cast<std::size_t>(y * n + x)] == 0) return false;
  return true;
}

void Movers::observe(const MapView& map, const Pose2& vehicle, double speed_mps) {
  movers_.erase(
      std::remove_if(movers_.begin(), movers_.end(),
                     [&](const Mover& mover) { return map.stamp_ns - mover.stamp_ns > kBefore_ns; }),
      movers_.end());
  if (const Past* before = past(map.stamp_ns - kBefore_ns)) {
    const Cells cells = map.cells();
    const DiscRows near(cells, vehicle.place(), kNear_m);
    near.for_each([&](int cell) {
      if ((map.flags[cell] & kHard) == 0) return;
      const Eigen::Vector2d place_m = cells.center_of(cell);
      if (!was_open(*before, place_m)) return;
      const double away_m = (place_m - vehicle.place()).norm();
      const double until_s = away_m / std::max(kLeastSpeed_mps, speed_mps);
      add(place_m, std::clamp(kWalks_mps * until_s, kLeast_m, speed_mps > 0 ? kMost_m : kLeast_m),
          map.stamp_ns);
    });
  }
  remember(map);
}

void Movers::add(const Eigen::Vector2d& place_m, double radius_m, std::int64_t stamp_ns) {
  for (Mover& mover : movers_)
    if ((mover.middle_m - place_m).norm() <= kCluster_m) {
      mover = {place_m, radius_m, stamp_ns};
      return;
    }
  if (movers_.size() < kMost) movers_.push_back({place_m, radius_m, stamp_ns});
}

MapView Movers::close(const MapView& map) {
  if (movers_.empty()) return map;
  const Cells cells = map.cells();
  std::copy_n(map.flags, cells.count(), flags_.begin());
  for (const Mover& mover : movers_)
    DiscRows(cells, mover.middle_m, mover.radius_m).for_each([&](int cell) {
      flags_[static_cast<std::size_t>(cell)] |= kHard;
    });
  MapView closed = map;
  closed.flags = flags_.data();
  return closed;
}

}  // namespace gvom::planner
