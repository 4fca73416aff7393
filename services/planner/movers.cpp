#include "services/planner/movers.hpp"

#include <algorithm>
#include <cmath>

#include "services/planner/disc.hpp"

namespace gvom::planner {
namespace {

constexpr std::uint8_t kStands = kHard | kSoft;
constexpr double kStraight = 0.7;  // the cosine between a way and the one before
constexpr double kAlone_m = 1.2;

/// Whether a column is so in the square that reaches this far from the column to each side.
template <class IsSo>
bool any_near(const Cells& cells, int index, double reach_m, IsSo is_so) {
  const int reach = static_cast<int>(std::ceil(reach_m / cells.cell_m - 1e-9));
  const int x0 = index % cells.n, y0 = index / cells.n;
  for (int y = std::max(0, y0 - reach); y <= std::min(cells.n - 1, y0 + reach); ++y)
    for (int x = std::max(0, x0 - reach); x <= std::min(cells.n - 1, x0 + reach); ++x)
      if (is_so(y * cells.n + x)) return true;
  return false;
}

}  // namespace

Movers::Movers(const VehicleLimits& vehicle, int n_xy) : vehicle_(vehicle) {
  const auto count = static_cast<std::size_t>(n_xy) * static_cast<std::size_t>(n_xy);
  for (Past& past : pasts_) {
    past.known.resize(count);
    past.standing.resize(count);
  }
  flags_.resize(count);
  found_.reserve(kMost);
  tracks_.reserve(kMost);
  discs_.reserve(kMost * (static_cast<std::size_t>(kAhead_m / kAround_m) + 1));
}

void Movers::clear() {
  taken_ = 0;
  tracks_.clear();
  discs_.clear();
}

void Movers::observe(const MapView& map, const Eigen::Vector2d& vehicle_m, double speed_mps) {
  found_.clear();
  if (const Past* past = past_of(map.stamp_ns)) find(map, *past, vehicle_m);
  follow(map);
  reach(vehicle_m, speed_mps);
  remember(map);
}

void Movers::remember(const MapView& map) {
  constexpr auto kLeast = static_cast<std::uint8_t>(Visibility::ground_assumed);
  Past& now = pasts_[taken_++ % kPasts];
  now.stamp_ns = map.stamp_ns;
  now.cells = map.cells();
  for (int i = 0; i < now.cells.count(); ++i) {
    now.known[static_cast<std::size_t>(i)] = map.visibility[i] >= kLeast && map.height[i] == map.height[i];
    now.standing[static_cast<std::size_t>(i)] = (map.flags[i] & kStands) != 0;
  }
}

const Movers::Past* Movers::past_of(std::int64_t stamp_ns) const {
  for (std::size_t back = 1; back <= std::min(taken_, kPasts); ++back) {
    const Past& past = pasts_[(taken_ - back) % kPasts];
    if (past.stamp_ns <= stamp_ns - kBack_ns) return &past;
  }
  return nullptr;
}

bool Movers::is_by_hole(const MapView& map, int index) {
  return any_near(map.cells(), index, kByHole_m, [&](int i) { return (map.flags[i] & kNegative) != 0; });
}

bool Movers::was_open(const Past& past, const Eigen::Vector2d& place_m) {
  const int index = past.cells.index_of(place_m.x(), place_m.y());
  if (index < 0 || past.known[static_cast<std::size_t>(index)] == 0) return false;
  return !any_near(past.cells, index, kEdge_m,
                   [&](int i) { return past.standing[static_cast<std::size_t>(i)] != 0; });
}

bool Movers::is_alone(const MapView& map, const Eigen::Vector2d& place_m) {
  const Cells cells = map.cells();
  int standing = 0;
  DiscRows(cells, place_m, kAlone_m).for_each([&](int cell) {
    standing += (map.flags[cell] & kStands) != 0 ? 1 : 0;
  });
  return standing * cells.cell_m * cells.cell_m <= kLargest_m2;
}

void Movers::find(const MapView& map, const Past& past, const Eigen::Vector2d& vehicle_m) {
  const Cells cells = map.cells();
  DiscRows(cells, vehicle_m, kSight_m).for_each([&](int cell) {
    if ((map.flags[cell] & kStands) == 0) return;
    const Eigen::Vector2d middle_m = cells.center_of(cell);
    if (was_open(past, middle_m) && !is_by_hole(map, cell)) add(middle_m);
  });
}

void Movers::add(const Eigen::Vector2d& place_m) {
  for (Found& found : found_) {
    if ((found.middle_m - place_m).norm() > kApart_m) continue;
    ++found.columns;
    found.middle_m += (place_m - found.middle_m) / found.columns;
    return;
  }
  if (found_.size() < kMost) found_.push_back({place_m, 1});
}

void Movers::follow(const MapView& map) {
  const std::int64_t stamp_ns = map.stamp_ns;
  const double cell_m = map.cells().cell_m;
  for (const Found& found : found_) {
    if (found.columns * cell_m * cell_m > kLargest_m2) continue;
    const auto is_it = [&](const Track& track) {
      return (track.middle_m - found.middle_m).norm() <= kApart_m;
    };
    const auto track = std::find_if(tracks_.begin(), tracks_.end(), is_it);
    if (track != tracks_.end())
      go_on(map, found.middle_m, *track);
    else if (tracks_.size() < kMost)
      tracks_.push_back({found.middle_m, stamp_ns, found.middle_m, stamp_ns, {0, 0}, 0, false});
  }
  for (Track& track : tracks_) track.moves = track.moves && stamp_ns - track.moved_ns <= kHold_ns;
  const auto is_over = [&](const Track& track) { return stamp_ns - track.seen_ns > kHold_ns; };
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), is_over), tracks_.end());
}

void Movers::go_on(const MapView& map, const Eigen::Vector2d& middle_m, Track& track) {
  track.middle_m = middle_m;
  track.seen_ns = map.stamp_ns;
  const Eigen::Vector2d way_m = middle_m - track.from_m;
  const double seconds = 1e-9 * static_cast<double>(map.stamp_ns - track.from_ns);
  const int from = map.cells().index_of(track.from_m.x(), track.from_m.y());
  const bool left = from >= 0 && (map.flags[from] & kStands) == 0;
  const bool moved = way_m.norm() >= kMoved_m && way_m.norm() <= kRuns_mps * seconds && left;
  if (moved) {
    const bool goes_on = track.direction.dot(way_m.normalized()) >= kStraight;
    track.direction = way_m.normalized();
    if (goes_on || is_alone(map, middle_m)) {
      track.moved_ns = map.stamp_ns;
      track.moves = true;
    }
  }
  if (!moved && map.stamp_ns - track.from_ns <= kGoing_ns) return;
  track.from_m = middle_m;
  track.from_ns = map.stamp_ns;
}

void Movers::reach(const Eigen::Vector2d& vehicle_m, double speed_mps) {
  discs_.clear();
  const double fast_mps = std::abs(speed_mps);
  const double stands_s = vehicle_.latency_s + fast_mps / vehicle_.max_decel_mps2;
  for (const Track& track : tracks_) {
    if (!track.moves) continue;
    const double away_m = (track.middle_m - vehicle_m).norm();
    const double seconds = std::min(away_m / std::max(fast_mps, 1e-3), stands_s);
    const double most_m = std::min(kWalks_mps * seconds, kAhead_m);
    for (double ahead_m = 0; ahead_m <= most_m; ahead_m += kAround_m)
      discs_.push_back({track.middle_m + ahead_m * track.direction, kAround_m + kWidens * ahead_m});
  }
}

MapView Movers::close(const MapView& map) {
  if (empty()) return map;
  const Cells cells = map.cells();
  std::copy_n(map.flags, cells.count(), flags_.begin());
  for (const Disc& disc : discs_)
    DiscRows(cells, disc.middle_m, disc.radius_m).for_each([&](int cell) {
      flags_[static_cast<std::size_t>(cell)] |= kHard;
    });
  MapView closed = map;
  closed.flags = flags_.data();
  return closed;
}

}  // namespace gvom::planner
