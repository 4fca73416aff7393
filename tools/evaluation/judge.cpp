#include "tools/evaluation/judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gvom::evaluation {
namespace {
constexpr double kNeared_m = 4.5;  // scenes with a hole at the end stop 3 m before it
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
/// Whether the vehicle came so near to the hole that it must have been barred.
bool was_neared(const std::vector<Approach>& approaches) {
  return std::any_of(approaches.begin(), approaches.end(),
                     [](const Approach& approach) { return approach.distance_m < kNeared_m; });
}

}  // namespace

Judge::Judge(const SceneFacts& facts, const SensorGeometry& sensor, Sight sight)
    : facts_(facts),
      sensor_(sensor),
      sight_(std::move(sight)),
      ground_(facts),
      path_(facts),
      objects_(facts),
      walkers_(facts),
      approaches_(facts.holes.size()) {}

void Judge::add(const Frame& frame) {
  ground_.add(frame, sight_);
  path_.add(frame);
  objects_.add(frame, sight_);
  walkers_.add(frame);
  judge_holes(frame);
}

void Judge::judge_holes(const Frame& frame) {
  for (std::size_t i = 0; i < facts_.holes.size(); ++i) {
    const double distance_m = facts_.holes[i].rim_driven_m - frame.driven_m;
    if (distance_m <= 0.0) continue;
    const auto& lanes = facts_.bars[i];
    const bool barred = std::all_of(lanes.begin(), lanes.end(), [&](const auto& columns) {
      return std::any_of(columns.begin(), columns.end(), [&](std::size_t column) {
        return flags_at(facts_.truth, frame, column) & kLethalFlags;
      });
    });
    approaches_[i].push_back({distance_m, barred});
  }
}

Figures Judge::result() const {
  Figures figures;
  ground_.fill(figures);
  path_.fill(figures);
  objects_.fill(figures);
  walkers_.fill(figures);
  fill_holes(figures);
  return figures;
}

// Of several holes the one that is barred latest, for what its geometry allows.
void Judge::fill_holes(Figures& figures) const {
  double worst = HUGE_VAL;
  for (std::size_t i = 0; i < approaches_.size(); ++i) {
    const double barred_m = barred_from_m(approaches_[i]);
    if (!was_neared(approaches_[i])) continue;
    const Hole& hole = facts_.holes[i];
    const double allowed_m = range_allowed_m(hole.width_m, sensor_.height_m, sensor_.beam_spacing_rad);
    if (barred_m / allowed_m >= worst) continue;
    worst = barred_m / allowed_m;
    figures[Figure::hole_barred_m] = barred_m;
    figures[Figure::hole_allowed_m] = hole.open ? kUnknown : allowed_m;
    figures[Figure::hole_ratio] = hole.open ? kUnknown : worst;
  }
}

}  // namespace gvom::evaluation
