#include "services/planner/standers.hpp"

#include <algorithm>
#include <utility>

namespace gvom::planner {
namespace {

constexpr double kSame_m = 0.6;  // so far it gets from map to map, at most

}  // namespace

Standers::Standers() {
  known_.reserve(kMost);
  set_off_.reserve(kMost);
}

const std::vector<Standers::SetOff>& Standers::observe(const MapView& map, const Eigen::Vector2d& vehicle_m,
                                                       double sight_m) {
  set_off_.clear();
  const auto is_over = [&](const Stander& one) { return map.stamp_ns - one.seen_ns > kHidden_ns; };
  known_.erase(std::remove_if(known_.begin(), known_.end(), is_over), known_.end());
  for_each_lone(map, vehicle_m, sight_m,
                [&](const Lone& lone) { see(lone, map.stamp_ns, map.cells().cell_m); });
  return set_off_;
}

void Standers::see(const Lone& lone, std::int64_t stamp_ns, double cell_m) {
  Stander* nearest = nullptr;
  double least_m = kSame_m;
  for (Stander& stander : known_) {
    const double away_m = (stander.middle_m - lone.middle_m).norm();
    if (away_m > least_m) continue;
    nearest = &stander;
    least_m = away_m;
  }
  if (nearest != nullptr && nearest->seen_ns != stamp_ns) return judge(lone, stamp_ns, cell_m, *nearest);
  if (nearest == nullptr && known_.size() < kMost) known_.push_back(begun(lone, stamp_ns));
}

void Standers::judge(const Lone& lone, std::int64_t stamp_ns, double cell_m, Stander& stander) {
  const double since = static_cast<double>(stamp_ns - stander.seen_ns) / kFollows_ns;
  stander.middle_m = lone.middle_m;
  stander.seen_ns = stamp_ns;
  const Eigen::Vector2d way_m = lone.middle_m - stander.stood_at_m;
  const bool was_off = std::exchange(stander.off, way_m.norm() >= kOff * cell_m);
  if (way_m.norm() <= kKept * cell_m) {
    stander.kept_ns = stamp_ns;
    stander.stood_at_m += std::min(since, 1.0) * way_m;
    stander.columns += std::min(since, 1.0) * (lone.columns - stander.columns);
    return;
  }
  const bool stood = stander.kept_ns - stander.since_ns >= kStood_ns;
  const bool is_same = lone.columns >= kLess * stander.columns && lone.columns <= kMore * stander.columns;
  const bool gets_on = stood && stamp_ns - stander.kept_ns <= kQuick_ns;
  if (gets_on && !(was_off && stander.off && is_same)) return;
  if (gets_on) set_off_.push_back({lone.middle_m, way_m.normalized()});
  stander = begun(lone, stamp_ns);
}

Standers::Stander Standers::begun(const Lone& lone, std::int64_t stamp_ns) {
  return {lone.middle_m, lone.middle_m, 1.0 * lone.columns, stamp_ns, stamp_ns, stamp_ns};
}

}  // namespace gvom::planner
