#include "services/planner/movers.hpp"

#include <algorithm>
#include <cmath>

#include "services/planner/kept_places.hpp"
#include "services/planner/lone.hpp"

namespace gvom::planner {
namespace {

constexpr double kStraight = 0.7;                     // the cosine between a way and the one before
constexpr int kSure = 2;                              // so often straight on
constexpr std::int64_t kMostAtOnce_ns = 200'000'000;  // of waiting; between two stands it drove

double seconds_of(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

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

Movers::Movers(const VehicleLimits& vehicle, int n_xy, double blind_m)
    : vehicle_(vehicle), beside_m_(blind_m + KeptPlaces::kBeyond_m) {
  const auto count = static_cast<std::size_t>(n_xy) * static_cast<std::size_t>(n_xy);
  for (Past& past : pasts_) {
    past.known.resize(count);
    past.standing.resize(count);
  }
  flags_.resize(count);
  found_.reserve(kMost);
  tracks_.reserve(kMost);
  discs_.reserve(kMost * (static_cast<std::size_t>(kAhead_m / kAround_m) + 2));
  before_.reserve(kMost * static_cast<std::size_t>(kBefore_m / kAround_m + 1));
}

void Movers::clear() {
  taken_ = 0;
  observed_ns_.reset();
  waited_ns_ = 0;
  standers_.clear();
  tracks_.clear();
  discs_.clear();
  before_.clear();
}

void Movers::observe(const MapView& map, const Eigen::Vector2d& vehicle_m, double speed_mps) {
  if (observed_ns_ != map.stamp_ns) {
    observed_ns_ = map.stamp_ns;
    found_.clear();
    if (const Past* past = past_of(map.stamp_ns)) find(map, *past, vehicle_m);
    follow(map, vehicle_m);
    for (const Standers::SetOff& one : standers_.observe(map, vehicle_m, kSight_m)) begin(one, map.stamp_ns);
    remember(map);
  }
  if ((vehicle_m - waits_at_m_).norm() > kHere_m) waited_ns_ = 0;
  close_ahead(map.stamp_ns, vehicle_m, speed_mps);
}

void Movers::wait(const Eigen::Vector2d& vehicle_m, std::int64_t stamp_ns) {
  if (waited_ns_ == 0) waits_at_m_ = vehicle_m;
  waited_ns_ += std::clamp<std::int64_t>(stamp_ns - waits_at_ns_, 1, kMostAtOnce_ns);
  waits_at_ns_ = stamp_ns;
}

void Movers::remember(const MapView& map) {
  constexpr auto kLeast = static_cast<std::uint8_t>(Visibility::ground_assumed);
  const Past* const newest = newest_past();
  if (newest != nullptr && map.stamp_ns - newest->stamp_ns < kPastEvery_ns) return;
  Past& now = pasts_[taken_++ % kPasts];
  now.stamp_ns = map.stamp_ns;
  now.cells = map.cells();
  for (int i = 0; i < now.cells.count(); ++i) {
    now.known[static_cast<std::size_t>(i)] = map.visibility[i] >= kLeast && map.height[i] == map.height[i];
    now.standing[static_cast<std::size_t>(i)] = (map.flags[i] & kStands) != 0;
  }
}

const Movers::Past* Movers::newest_past() const {
  return taken_ == 0 ? nullptr : &pasts_[(taken_ - 1) % kPasts];
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

void Movers::follow(const MapView& map, const Eigen::Vector2d& vehicle_m) {
  const std::int64_t stamp_ns = map.stamp_ns;
  const double cell_m = map.cells().cell_m;
  for (const Found& found : found_) {
    if (found.columns * cell_m * cell_m > kLargest_m2) continue;
    const auto lone = lone_at(map, found.middle_m);
    const Eigen::Vector2d middle_m = lone ? lone->middle_m : found.middle_m;
    if (Track* const track = track_of(middle_m, stamp_ns))
      go_on(map, middle_m, lone.has_value(), *track);
    else if (Track* const added = add_track())
      *added = {middle_m, stamp_ns, middle_m, stamp_ns};
  }
  for (Track& track : tracks_) {
    track.moves = track.moves && stamp_ns - track.moved_ns <= hold_ns(track, vehicle_m);
    if (!track.moves || track.seen_ns == stamp_ns) continue;
    if (const auto lone = lone_at(map, track.middle_m)) go_on(map, lone->middle_m, true, track);
  }
  const auto is_over = [&](const Track& track) {
    return stamp_ns - track.seen_ns > hold_ns(track, vehicle_m);
  };
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), is_over), tracks_.end());
}

void Movers::begin(const Standers::SetOff& one, std::int64_t stamp_ns) {
  if (waited_ns_ > kPatience_ns) return;
  Track* track = track_of(one.middle_m, stamp_ns);
  const bool is_his =
      track != nullptr && (!track->moves || (track->middle_m - one.middle_m).norm() < kAround_m);
  if (!is_his) track = add_track();
  if (track == nullptr) return;
  track->middle_m = track->from_m = one.middle_m;
  track->seen_ns = track->from_ns = track->moved_ns = stamp_ns;
  track->direction = one.direction;
  track->moves = track->sure = true;
}

Movers::Track* Movers::add_track() {
  if (tracks_.size() < kMost) return &tracks_.emplace_back();
  Track* oldest = nullptr;
  for (Track& track : tracks_)
    if (!track.moves && (oldest == nullptr || track.seen_ns < oldest->seen_ns)) oldest = &track;
  if (oldest != nullptr) *oldest = {};
  return oldest;
}

std::int64_t Movers::hold_ns(const Track& track, const Eigen::Vector2d& vehicle_m) const {
  return track.sure && (track.middle_m - vehicle_m).norm() < beside_m_ ? kHoldBeside_ns : kHold_ns;
}

Movers::Track* Movers::track_of(const Eigen::Vector2d& middle_m, std::int64_t stamp_ns) {
  Track* nearest = nullptr;
  double least_m = kApart_m;
  for (Track& track : tracks_) {
    const double walked_m = track.moves ? kWalks_mps * seconds_of(stamp_ns - track.seen_ns) : 0;
    const double away_m = (track.middle_m - middle_m).norm() - walked_m;
    if (away_m > least_m) continue;
    nearest = &track;
    least_m = away_m;
  }
  return nearest;
}

void Movers::go_on(const MapView& map, const Eigen::Vector2d& middle_m, bool alone, Track& track) {
  track.middle_m = middle_m;
  track.seen_ns = map.stamp_ns;
  const Eigen::Vector2d way_m = middle_m - track.from_m;
  const double seconds = seconds_of(map.stamp_ns - track.from_ns);
  const int from = map.cells().index_of(track.from_m.x(), track.from_m.y());
  const bool left = from >= 0 && (map.flags[from] & kStands) == 0;
  const bool moved = way_m.norm() >= kMoved_m && way_m.norm() <= kRuns_mps * seconds && left;
  if (moved) {
    const bool goes_on = track.direction.dot(way_m.normalized()) >= kStraight;
    track.direction = way_m.normalized();
    track.straight = goes_on ? track.straight + 1 : 0;
    track.sure = track.sure || alone || track.straight >= kSure;
    if (goes_on || alone || is_alone(map, middle_m)) {
      track.moved_ns = map.stamp_ns;
      track.moves = true;
    }
  }
  if (!moved && map.stamp_ns - track.from_ns <= kGoing_ns) return;
  track.from_m = middle_m;
  track.from_ns = map.stamp_ns;
}

void Movers::close_ahead(std::int64_t stamp_ns, const Eigen::Vector2d& vehicle_m, double speed_mps) {
  discs_.clear();
  before_.clear();
  const double fast_mps = std::abs(speed_mps);
  const double stands_s = std::max(vehicle_.latency_s + fast_mps / vehicle_.max_decel_mps2, kLeast_s);
  for (const Track& track : tracks_) {
    if (!track.moves || (!track.sure && waited_ns_ > kPatience_ns)) continue;
    const double away_m = (track.middle_m - vehicle_m).norm();
    const double seconds = std::min(away_m / std::max(fast_mps, 1e-3), stands_s);
    if (track.sure && stamp_ns - track.moved_ns > kTurns_ns) {
      const double far_m = kWalks_mps * (seconds + seconds_of(stamp_ns - track.seen_ns));
      discs_.push_back({track.middle_m, kAround_m + std::min(far_m, kAhead_m), true});
      continue;
    }
    const double most_m = std::min(kWalks_mps * seconds, kAhead_m);
    for (double ahead_m = 0; ahead_m < most_m; ahead_m += kAround_m)
      discs_.push_back(ahead_of(track, ahead_m));
    discs_.push_back(ahead_of(track, most_m));
    if (!track.sure) continue;
    for (double ahead_m = most_m + kAround_m; ahead_m < most_m + kBefore_m; ahead_m += kAround_m)
      before_.push_back(ahead_of(track, ahead_m));
  }
}

Movers::Disc Movers::ahead_of(const Track& track, double ahead_m) {
  return {track.middle_m + ahead_m * track.direction, kAround_m + kWidens * ahead_m, track.sure};
}

bool Movers::reach(const Pose2& pose) const {
  return std::any_of(discs_.begin(), discs_.end(), [&](const Disc& disc) {
    if (!disc.sure) return false;
    const Eigen::Vector2d off_m = disc.middle_m - pose.place(), forward = pose.forward();
    const double ahead_m = off_m.dot(forward);
    const double aside_m = std::abs(off_m.y() * forward.x() - off_m.x() * forward.y());
    if (ahead_m < -vehicle_.rear_m) return false;
    const double to_side_m = std::max(aside_m - vehicle_.width_m / 2, 0.0);
    return std::hypot(std::max(ahead_m - vehicle_.front_m, 0.0), to_side_m) < disc.radius_m;
  });
}

MapView Movers::close(const MapView& map) {
  if (empty()) return map;
  std::copy_n(map.flags, map.cells().count(), flags_.begin());
  mark(map.cells(), before_, kSoft);
  mark(map.cells(), discs_, kHard);
  return with_flags(map, flags_);
}

MapView Movers::discourage(const MapView& map) {
  std::copy_n(map.flags, map.cells().count(), flags_.begin());
  mark(map.cells(), discs_, kSoft);
  return with_flags(map, flags_);
}

void Movers::mark(const Cells& cells, const std::vector<Disc>& discs, std::uint8_t flag) {
  for (const Disc& disc : discs)
    DiscRows(cells, disc.middle_m, disc.radius_m).for_each([&](int cell) {
      flags_[static_cast<std::size_t>(cell)] |= flag;
    });
}

}  // namespace gvom::planner
