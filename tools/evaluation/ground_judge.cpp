#include "tools/evaluation/ground_judge.hpp"

#include <algorithm>
#include <cmath>

namespace gvom::evaluation {
namespace {

constexpr double kWalkerRoom_m = 1.0;
constexpr int kFramesPerSight = 4;

bool is_class(const Truth& truth, std::size_t column, ObjectClass expected) {
  return truth.classes[column] == static_cast<std::uint8_t>(expected);
}

}  // namespace

bool holds_walker(const SceneFacts& facts, const Frame& frame, const Eigen::Vector2d& middle_m) {
  return std::any_of(facts.walkers.begin(), facts.walkers.end(), [&](const sim::Object* walker) {
    return (place_at(*walker, frame.time_s) - middle_m).norm() < kWalkerRoom_m;
  });
}

void GroundJudge::add(const Frame& frame, const Sight& sight) {
  const Truth& truth = facts_.truth;
  const bool asks_sight = frames_++ % kFramesPerSight == 0;
  for_each_column(truth, frame, [&](std::size_t at, std::size_t mine, const Eigen::Vector2d& middle_m) {
    const Column column{at, frame.ahead_m(middle_m), frame.flags[mine], frame.visibility[mine],
                        frame.height[mine]};
    if (column.visibility == 0 && column.ahead_m > kFar_m) return;
    if (holds_walker(facts_, frame, middle_m)) return;
    if (truth.drivable[at]) judge_drivable(frame, sight, column);
    if (truth.drivable[at] && asks_sight) judge_coverage_in_sight(frame, sight, column);
    if (ground_is_known(column.visibility, column.height)) judge_height(column);
    if (!is_observed(column.visibility) || column.ahead_m > kNear_m) return;
    if (truth.lethal[at]) lethal_found_.count(column.flags & kLethalFlags);
    if (!is_class(truth, at, ObjectClass::grass)) return;
    grass_soft_.count(column.flags & kSoft);
    grass_hard_.count(column.flags & kHard);
  });
}

void GroundJudge::judge_drivable(const Frame& frame, const Sight& sight, const Column& column) {
  const bool known = ground_is_known(column.visibility, column.height);
  if (column.ahead_m <= kNear_m) coverage_near_.count(known);
  if (column.ahead_m <= kFar_m) coverage_far_.count(known);
  if (!is_observed(column.visibility)) return;
  if (column.flags & kNegative && is_behind_edge(facts_, frame, sight, column.truth)) return;
  negative_.count(column.ahead_m, column.flags & kNegative);
  hard_.count(column.ahead_m, column.flags & kHard);
  steep_.count(column.ahead_m, column.flags & kSteep);
  lethal_.count(column.ahead_m, column.flags & kLethalFlags);
}

void GroundJudge::judge_coverage_in_sight(const Frame& frame, const Sight& sight, const Column& column) {
  if (column.ahead_m > kFar_m || !ground_in_sight(facts_, frame, sight, column.truth)) return;
  const bool known = ground_is_known(column.visibility, column.height);
  sight_far_.count(known);
  if (column.ahead_m <= kNear_m) sight_near_.count(known);
}

void GroundJudge::judge_height(const Column& column) {
  const Truth& truth = facts_.truth;
  if (!std::isfinite(column.height)) return;
  const float error = column.height - truth.ground_lowest[column.truth];
  errors_.all.add(error);
  if (truth.vegetation[column.truth]) errors_.vegetation.add(error);
  const bool bare = is_class(truth, column.truth, ObjectClass::ground) && !truth.vegetation[column.truth];
  if (!bare) return;
  errors_.bare.add(error);
  if (column.ahead_m <= kNear_m) errors_.bare_near.add(error);
}

void GroundJudge::fill(Figures& figures) const {
  const auto put = [&](const ShareByRange& shares, Figure near, Figure far, Figure any) {
    figures[near] = shares.near.percent();
    figures[far] = shares.far.percent();
    figures[any] = shares.any.percent();
  };
  put(negative_, Figure::negative_near, Figure::negative_30, Figure::negative_any);
  put(hard_, Figure::hard_near, Figure::hard_30, Figure::hard_any);
  put(steep_, Figure::steep_near, Figure::steep_30, Figure::steep_any);
  put(lethal_, Figure::lethal_near, Figure::lethal_30, Figure::lethal_any);
  figures[Figure::lethal_found_near] = lethal_found_.percent();
  figures[Figure::grass_soft] = grass_soft_.percent();
  figures[Figure::grass_hard] = grass_hard_.percent();
  figures[Figure::coverage_near] = coverage_near_.percent();
  figures[Figure::coverage_30] = coverage_far_.percent();
  figures[Figure::sight_coverage_near] = sight_near_.percent();
  figures[Figure::sight_coverage_30] = sight_far_.percent();
  const auto spread = [&](const Spread& errors, Figure bias, Figure median, Figure p95) {
    figures[bias] = errors.mean();
    figures[median] = errors.quantile(0.5);
    figures[p95] = errors.quantile(0.95);
  };
  spread(errors_.bare_near, Figure::bare_near_bias, Figure::bare_near_median, Figure::bare_near_p95);
  spread(errors_.bare, Figure::bare_bias, Figure::bare_median, Figure::bare_p95);
  spread(errors_.vegetation, Figure::vegetation_bias, Figure::vegetation_median, Figure::vegetation_p95);
  spread(errors_.all, Figure::height_bias, Figure::height_median, Figure::height_p95);
}

void PathJudge::add(const Frame& frame) {
  const Truth& truth = facts_.truth;
  bool near = false, far = false, known = false;
  for_each_column(truth, frame, [&](std::size_t at, std::size_t mine, const Eigen::Vector2d& middle_m) {
    const double ahead_m = facts_.path_driven_m[at] - frame.driven_m;
    if (!(ahead_m > 0.0 && ahead_m <= kFar_m) || !truth.drivable[at]) return;
    known = true;
    if ((frame.flags[mine] & kLethalFlags) == 0 || holds_walker(facts_, frame, middle_m)) return;
    far = true;
    near = near || ahead_m <= kNear_m;
  });
  if (!known) return;
  barred_near_.count(near);
  barred_far_.count(far);
}

void PathJudge::fill(Figures& figures) const {
  figures[Figure::path_barred_15] = barred_near_.percent();
  figures[Figure::path_barred_30] = barred_far_.percent();
}

}  // namespace gvom::evaluation
