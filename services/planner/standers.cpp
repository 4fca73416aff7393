#include "services/planner/standers.hpp"

#include <algorithm>
#include <utility>

#include "services/planner/lone.hpp"

namespace gvom::planner {
namespace {

constexpr double kSame_m = 0.6;   // so far it gets from map to map, at most
constexpr double kFollows = 0.2;  // a nearer vehicle sees another side of it

}  // namespace

Standers::Standers() {
  known_.reserve(kMost);
  set_off_.reserve(kMost);
}

const std::vector<Standers::SetOff>& Standers::observe(const MapView& map, const Eigen::Vector2d& vehicle_m,
                                                       double sight_m) {
  set_off_.clear();
  for_each_lone(map, vehicle_m, sight_m,
                [&](const Eigen::Vector2d& middle_m) { see(middle_m, map.stamp_ns, map.cells().cell_m); });
  const auto is_over = [&](const Stander& one) { return map.stamp_ns - one.seen_ns > kHidden_ns; };
  known_.erase(std::remove_if(known_.begin(), known_.end(), is_over), known_.end());
  return set_off_;
}

void Standers::see(const Eigen::Vector2d& middle_m, std::int64_t stamp_ns, double cell_m) {
  Stander* nearest = nullptr;
  double least_m = kSame_m;
  for (Stander& stander : known_) {
    const double away_m = (stander.middle_m - middle_m).norm();
    if (away_m > least_m) continue;
    nearest = &stander;
    least_m = away_m;
  }
  if (nearest == nullptr) {
    if (known_.size() < kMost) known_.push_back({middle_m, middle_m, stamp_ns, stamp_ns, stamp_ns});
  } else if (nearest->seen_ns != stamp_ns) {
    judge(middle_m, stamp_ns, cell_m, *nearest);
  }
}

void Standers::judge(const Eigen::Vector2d& middle_m, std::int64_t stamp_ns, double cell_m,
                     Stander& stander) {
  stander.middle_m = middle_m;
  stander.seen_ns = stamp_ns;
  const Eigen::Vector2d way_m = middle_m - stander.stood_at_m;
  const bool was_off = std::exchange(stander.off, way_m.norm() >= kOff * cell_m);
  if (way_m.norm() <= kKept * cell_m) {
    stander.kept_ns = stamp_ns;
    stander.stood_at_m += kFollows * way_m;
    return;
  }
  const bool stood = stander.kept_ns - stander.since_ns >= kStood_ns;
  const bool sets_off = stood && stamp_ns - stander.kept_ns <= kQuick_ns;
  if (sets_off && !(was_off && stander.off)) return;
  if (sets_off) set_off_.push_back({middle_m, way_m.normalized()});
  stander = {middle_m, middle_m, stamp_ns, stamp_ns, stamp_ns};
}

}  // namespace gvom::planner
