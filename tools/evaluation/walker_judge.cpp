#include "tools/evaluation/walker_judge.hpp"

#include <algorithm>
#include <map>

namespace gvom::evaluation {
namespace {

constexpr double kStep_s = 0.02;
constexpr double kBody_m = 0.3;   // of a walker: what lies within it may be hit
constexpr double kReach_m = 0.6;  // of the columns that show a walker

bool is_free(const Truth& truth, std::size_t column) {
  const auto what = static_cast<ObjectClass>(truth.classes[column]);
  return (what == ObjectClass::ground || what == ObjectClass::person) && !truth.vegetation[column];
}

/// The columns whose middle lies within `radius_m` of a point.
std::vector<std::size_t> columns_around(const Truth& truth, const Eigen::Vector2d& centre_m,
                                        double radius_m) {
  std::vector<std::size_t> columns;
  const auto steps = static_cast<int>(radius_m / truth.resolution_m) + 1;
  for (int y = -steps; y <= steps; ++y)
    for (int x = -steps; x <= steps; ++x) {
      const std::int64_t column = column_at(truth, centre_m + truth.resolution_m * Eigen::Vector2d(x, y));
      if (column < 0) continue;
      const auto at = static_cast<std::size_t>(column);
      if ((middle_of(truth, at) - centre_m).norm() <= radius_m) columns.push_back(at);
    }
  return columns;
}

}  // namespace

WalkerJudge::WalkerJudge(const SceneFacts& facts) : facts_(facts) {
  for (const sim::Object* walker : facts.walkers) {
    std::map<std::size_t, double> left_s;
    const double begin_s = walker->track.front().time_s, end_s = walker->track.back().time_s;
    for (double time_s = begin_s; time_s < end_s; time_s += kStep_s)
      for (const std::size_t column : columns_around(facts.truth, place_at(*walker, time_s), kBody_m))
        if (is_free(facts.truth, column)) left_s[column] = time_s;
    Way way{walker, {}};
    for (const auto& [column, time_s] : left_s) way.columns.push_back({column, time_s});
    ways_.push_back(std::move(way));
  }
}

void WalkerJudge::judge_presence(const Frame& frame, const sim::Object& walker) {
  const Eigen::Vector2d place_m = place_at(walker, frame.time_s);
  if (frame.ahead_m(place_m) > kNear_m) return;
  const std::vector<std::size_t> columns = columns_around(facts_.truth, place_m, kReach_m);
  found_.count(std::any_of(columns.begin(), columns.end(), [&](std::size_t column) {
    return flags_at(facts_.truth, frame, column) & kObstacleFlags;
  }));
}

void WalkerJudge::add(const Frame& frame) {
  for (Way& way : ways_) {
    judge_presence(frame, *way.walker);
    const Eigen::Vector2d walker_m = place_at(*way.walker, frame.time_s);
    for (Left& left : way.columns) {
      const Eigen::Vector2d middle_m = middle_of(facts_.truth, left.column);
      // The walker's own columns, and those beside them, show the walker and no ghost.
      if (frame.time_s <= left.left_s || (middle_m - walker_m).norm() <= kReach_m) continue;
      if (frame.ahead_m(middle_m) > kNear_m) continue;
      if (!is_observed(visibility_at(facts_.truth, frame, left.column))) continue;
      left.judged = true;
      if (flags_at(facts_.truth, frame, left.column) & kObstacleFlags)
        left.ghost_s = frame.time_s - left.left_s;
    }
  }
}

void WalkerJudge::fill(Figures& figures) const {
  Spread trail_s;
  for (const Way& way : ways_)
    for (const Left& left : way.columns)
      if (left.judged) trail_s.add(static_cast<float>(left.ghost_s));
  figures[Figure::walker_found] = found_.percent();
  figures[Figure::trail_median_s] = trail_s.quantile(0.5);
  figures[Figure::trail_p95_s] = trail_s.quantile(0.95);
  figures[Figure::trail_max_s] = trail_s.quantile(1.0);
}

}  // namespace gvom::evaluation
