#include "tools/evaluation/object_judge.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::evaluation {
namespace {

constexpr double kTrunkHeight_m = 1.2;  // of the point of a trunk that must be in sight
constexpr double kSlack_m = 0.1;
constexpr double kLowestRock_m = 0.5;
constexpr double kHeights_m[] = {0.3, 0.6, 1.0, 1.4};  // of the points of a wall, a car, a rock

/// Whether a ray towards a trunk's middle ends at its bark.
bool in_sight(const Sight& sight, const Frame& frame, const Trunk& trunk) {
  const Eigen::Vector3d to_m(trunk.centre_m.x(), trunk.centre_m.y(), trunk.foot_m + kTrunkHeight_m);
  const double range_m = sight(frame.sensor_m, to_m);
  return range_m >= (to_m - frame.sensor_m).norm() - trunk.radius_m - kSlack_m;
}

/// Whether a ray towards the middle of a column, at a height below the object's top, ends within it.
bool in_sight(const Sight& sight, const Frame& frame, const SceneFacts& facts, std::size_t column) {
  const sim::Object& object = facts.world.objects[static_cast<std::size_t>(facts.truth.object[column])];
  const Eigen::Vector2d middle_m = middle_of(facts.truth, column);
  return std::any_of(std::begin(kHeights_m), std::end(kHeights_m), [&](double height_m) {
    if (height_m >= object.height_m) return false;
    const Eigen::Vector3d to_m(middle_m.x(), middle_m.y(), facts.truth.ground_mean[column] + height_m);
    const double range_m = sight(frame.sensor_m, to_m);
    const double way_m = (to_m - frame.sensor_m).norm();
    const Eigen::Vector3d hit_m = frame.sensor_m + std::min(range_m / way_m, 1.0) * (to_m - frame.sensor_m);
    return std::isfinite(range_m) &&
           column_at(facts.truth, hit_m.head<2>()) == static_cast<std::int64_t>(column);
  });
}

}  // namespace

ObjectJudge::ObjectJudge(const SceneFacts& facts)
    : facts_(facts), trunk_was_near_(facts.trunks.size(), 0), trunk_was_hard_(facts.trunks.size(), 0) {}

void ObjectJudge::add(const Frame& frame, const Sight& sight) {
  judge_trunks(frame, sight);
  for_each_column(facts_.truth, frame,
                  [&](std::size_t at, std::size_t mine, const Eigen::Vector2d& middle_m) {
                    if (frame.ahead_m(middle_m) > kNear_m) return;
                    judge_solid(frame, sight, at, frame.flags[mine]);
                    if (is_observed(frame.visibility[mine])) judge_bush(at, frame.flags[mine]);
                  });
}

void ObjectJudge::judge_trunks(const Frame& frame, const Sight& sight) {
  for (std::size_t i = 0; i < facts_.trunks.size(); ++i) {
    const Trunk& trunk = facts_.trunks[i];
    const double ahead_m = frame.ahead_m(trunk.centre_m);
    if (ahead_m > kFar_m || !in_sight(sight, frame, trunk)) continue;
    const bool hard = std::any_of(trunk.columns.begin(), trunk.columns.end(), [&](std::size_t column) {
      return flags_at(facts_.truth, frame, column) & kHard;
    });
    trunks_far_.count(hard);
    if (ahead_m > kNear_m) continue;
    trunks_near_.count(hard);
    trunk_was_near_[i] = 1;
    trunk_was_hard_[i] |= static_cast<char>(hard);
  }
}

Share* ObjectJudge::share_of(std::size_t column) {
  if (facts_.truth.object[column] < 0) return nullptr;
  switch (static_cast<ObjectClass>(facts_.truth.classes[column])) {
    case ObjectClass::wall:
      return &walls_;
    case ObjectClass::car:
      return &cars_;
    case ObjectClass::rock: {
      const auto object = static_cast<std::size_t>(facts_.truth.object[column]);
      return facts_.world.objects[object].height_m >= kLowestRock_m ? &rocks_ : nullptr;
    }
    default:
      return nullptr;
  }
}

void ObjectJudge::judge_solid(const Frame& frame, const Sight& sight, std::size_t column,
                              std::uint8_t flags) {
  Share* share = share_of(column);
  if (share != nullptr && in_sight(sight, frame, facts_, column)) share->count(flags & kHard);
}

void ObjectJudge::judge_bush(std::size_t column, std::uint8_t flags) {
  if (facts_.truth.classes[column] != static_cast<std::uint8_t>(ObjectClass::bush)) return;
  if (facts_.trunk_beside[column]) return;
  const bool under_crown = facts_.crown_beside[column];
  if (!under_crown) bushes_found_.count(flags & kObstacleFlags);
  (under_crown ? crown_bushes_hard_ : bushes_hard_).count(flags & kHard);
  if (flags & kObstacleFlags) (under_crown ? crown_bushes_soft_ : bushes_soft_).count(!(flags & kHard));
}

void ObjectJudge::fill(Figures& figures) const {
  Share ever;
  for (std::size_t i = 0; i < trunk_was_near_.size(); ++i)
    if (trunk_was_near_[i]) ever.count(trunk_was_hard_[i]);
  figures[Figure::trunks_ever] = ever.percent();
  figures[Figure::trunks_near] = trunks_near_.percent();
  figures[Figure::trunks_30] = trunks_far_.percent();
  figures[Figure::walls_near] = walls_.percent();
  figures[Figure::cars_near] = cars_.percent();
  figures[Figure::rocks_near] = rocks_.percent();
  figures[Figure::bushes_found] = bushes_found_.percent();
  figures[Figure::bushes_soft] = bushes_soft_.percent();
  figures[Figure::bushes_hard] = bushes_hard_.percent();
  figures[Figure::crown_bushes_soft] = crown_bushes_soft_.percent();
  figures[Figure::crown_bushes_hard] = crown_bushes_hard_.percent();
}

}  // namespace gvom::evaluation
