#include "tools/truth/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gvom::truth {
namespace {

constexpr double kTallRock = 0.9;
constexpr float kDeepDitch = 0.5F;
constexpr float kBottom = 0.3F;
constexpr double kPersonReach = 0.6;
constexpr double kPersonGone = 1.5;
constexpr std::size_t kHeadingFrames = 4;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// The low bits of `ever_` are those of `Flag`, without ASSUMED; these follow.
enum Ever : std::uint8_t { kBottomSeen = 16, kClearanceSeen = 32, kWasNear = 64 };
constexpr std::uint8_t kObstacle = kHard | kSoft;
constexpr std::uint8_t kLethal = kHard | kNegative | kSteep;

ErrorSummary summarize(std::vector<float> errors) {
  if (errors.empty()) return {0, kUnknown, kUnknown, kUnknown};
  double sum = 0.0;
  for (float& error : errors) {
    sum += error;
    error = std::abs(error);
  }
  std::sort(errors.begin(), errors.end());
  const auto quantile = [&](double q) {
    return static_cast<double>(errors[static_cast<std::size_t>(q * static_cast<double>(errors.size() - 1))]);
  };
  return {errors.size(), sum / static_cast<double>(errors.size()), quantile(0.5), quantile(0.95)};
}

/// Ground whose neighbours, diagonal ones too, are ground as well.
std::vector<std::uint8_t> plain_ground(const Truth& truth) {
  std::vector<std::uint8_t> plain(truth.classes.size(), 0);
  for (int y = 1; y + 1 < truth.size_y; ++y)
    for (int x = 1; x + 1 < truth.size_x; ++x) {
      bool all = true;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          all = all && truth.classes[static_cast<std::size_t>(y + dy) * truth.size_x + x + dx] == kGround;
      plain[static_cast<std::size_t>(y) * truth.size_x + x] = all;
    }
  return plain;
}

bool is_under_branch(const Truth& truth, std::size_t at) {
  return truth.classes[at] == kOverhang && truth.object[at] >= 0 &&
         truth.objects[truth.object[at]].kind == "branch";
}

/// The person's place at a time; the ends of the track hold beyond them.
std::array<double, 2> person_at(const std::vector<TrackPoint>& track, double time_s) {
  const auto after =
      std::find_if(track.begin(), track.end(), [&](const TrackPoint& p) { return p.time_s >= time_s; });
  if (after == track.begin()) return {after->x_m, after->y_m};
  const TrackPoint& before = *(after - 1);
  if (after == track.end()) return {before.x_m, before.y_m};
  const double part = (time_s - before.time_s) / (after->time_s - before.time_s);
  return {before.x_m + part * (after->x_m - before.x_m), before.y_m + part * (after->y_m - before.y_m)};
}

}  // namespace

double Share::ratio() const {
  return of == 0 ? kUnknown : static_cast<double>(hits) / static_cast<double>(of);
}

/// One column of one map, with its place in the truth.
struct Evaluator::Column {
  std::size_t at;  // in the truth's layers
  bool near;
  float height;
  std::uint8_t flags;
  std::uint8_t visibility;
};

Evaluator::Evaluator(const Truth& truth, double within_m)
    : truth_(truth), plain_(plain_ground(truth)), ever_(truth.classes.size(), 0) {
  sums_.within_m = within_m;
}

void Evaluator::judge_ground(const Column& column) {
  constexpr std::uint8_t kGroundSeen = 3;
  if (truth_.classes[column.at] == kGround && column.visibility == kGroundSeen &&
      !(column.flags & kAssumed)) {
    const float lowest = column.height - truth_.ground_lowest[column.at];
    const float mean = column.height - truth_.ground_mean[column.at];
    error_lowest_.push_back(lowest);
    error_mean_.push_back(mean);
    if (column.near) near_error_lowest_.push_back(lowest);
    if (column.near) near_error_mean_.push_back(mean);
  }
  if (!plain_[column.at] || column.visibility == 0) return;
  const auto count = [&](Flag flag, Share& anywhere, Share& near) {
    anywhere.count(column.flags & flag);
    if (column.near) near.count(column.flags & flag);
  };
  count(kHard, sums_.false_hard, sums_.near_false_hard);
  count(kSoft, sums_.false_soft, sums_.near_false_soft);
  count(kNegative, sums_.false_negative, sums_.near_false_negative);
  count(kSteep, sums_.false_steep, sums_.near_false_steep);
}

void Evaluator::judge_person(const Frame& frame, const std::array<double, 2>& heading) {
  if (truth_.person.empty()) return;
  const FrameInfo& info = frame.info;
  const std::array<double, 2> person = person_at(truth_.person, 1e-9 * static_cast<double>(info.stamp_ns));
  const std::array<double, 2> away{person[0] - info.base_m[0], person[1] - info.base_m[1]};
  if (std::hypot(away[0], away[1]) > sums_.within_m || away[0] * heading[0] + away[1] * heading[1] < 0.0)
    return;
  bool flagged = false;
  for (int y = 0; y < info.size; ++y)
    for (int x = 0; x < info.size; ++x) {
      const double east = (static_cast<double>(info.origin[0] + x) + 0.5) * info.resolution_m;
      const double north = (static_cast<double>(info.origin[1] + y) + 0.5) * info.resolution_m;
      const double distance = std::hypot(east - person[0], north - person[1]);
      const bool obstacle = frame.flags[static_cast<std::size_t>(y) * info.size + x] & kObstacle;
      flagged = flagged || (obstacle && distance < kPersonReach);
      const std::int64_t tx = info.origin[0] + x - truth_.origin[0];
      const std::int64_t ty = info.origin[1] + y - truth_.origin[1];
      if (distance < kPersonGone || tx < 0 || ty < 0 || tx >= truth_.size_x || ty >= truth_.size_y) continue;
      if (truth_.classes[ty * truth_.size_x + tx] == kPerson) sums_.person_left_behind.count(obstacle);
    }
  sums_.person_flagged.count(flagged);
}

void Evaluator::add(const Frame& frame, const std::array<double, 2>& heading) {
  const FrameInfo& info = frame.info;
  ++sums_.frames;
  judge_person(frame, heading);
  for (int y = 0; y < info.size; ++y) {
    const std::int64_t ty = info.origin[1] + y - truth_.origin[1];
    if (ty < 0 || ty >= truth_.size_y) continue;
    const double north = (static_cast<double>(info.origin[1] + y) + 0.5) * info.resolution_m - info.base_m[1];
    for (int x = 0; x < info.size; ++x) {
      const std::int64_t tx = info.origin[0] + x - truth_.origin[0];
      if (tx < 0 || tx >= truth_.size_x) continue;
      const double east =
          (static_cast<double>(info.origin[0] + x) + 0.5) * info.resolution_m - info.base_m[0];
      const std::size_t in_map = static_cast<std::size_t>(y) * info.size + x;
      const bool near = east * east + north * north <= sums_.within_m * sums_.within_m &&
                        east * heading[0] + north * heading[1] >= 0.0;
      const Column column{static_cast<std::size_t>(ty * truth_.size_x + tx), near, frame.height[in_map],
                          frame.flags[in_map], frame.visibility[in_map]};
      judge_ground(column);
      if (!near) continue;
      std::uint8_t& ever = ever_[column.at];
      ever |= kWasNear | (column.flags & (kObstacle | kLethal));
      if (std::abs(column.height - truth_.ground_lowest[column.at]) < kBottom) ever |= kBottomSeen;
      if (!is_under_branch(truth_, column.at) || !std::isfinite(frame.clearance[in_map])) continue;
      ever |= kClearanceSeen;
      clearance_error_.push_back(frame.clearance[in_map] - truth_.clearance[column.at]);
    }
  }
}

void Evaluator::count_columns(Evaluation& out) const {
  for (std::size_t at = 0; at < ever_.size(); ++at) {
    const std::uint8_t ever = ever_[at];
    if (!(ever & kWasNear)) continue;
    if (truth_.classes[at] == kTree) out.tree_columns_hard.count(ever & kHard);
    if (truth_.classes[at] == kBush) {
      out.bush_columns_soft.count(ever & kSoft);
      out.bush_columns_obstacle.count(ever & kObstacle);
    }
    if (truth_.classes[at] == kDitch && truth_.drop_m[at] >= kDeepDitch) {
      out.ditch_negative.count(ever & kNegative);
      out.ditch_steep.count(ever & kSteep);
      out.ditch_hard.count(ever & kHard);
      out.ditch_bottom_seen.count(ever & kBottomSeen);
      out.ditch_lethal.count(ever & kLethal);
    }
    if (truth_.classes[at] == kStepFace) out.step_columns_lethal.count(ever & kLethal);
    if (is_under_branch(truth_, at)) out.branch_columns_seen.count(ever & kClearanceSeen);
  }
}

void Evaluator::count_objects(Evaluation& out) const {
  std::vector<std::uint8_t> ever(truth_.objects.size(), 0);
  for (std::size_t at = 0; at < ever_.size(); ++at) {
    const bool standing = truth_.classes[at] >= kTree && truth_.classes[at] <= kRock;
    if (standing && truth_.object[at] >= 0) ever[truth_.object[at]] |= ever_[at];
  }
  for (std::size_t i = 0; i < ever.size(); ++i) {
    if (!(ever[i] & kWasNear)) continue;
    const Object& object = truth_.objects[i];
    if (object.kind == "tree") out.trees_hard.count(ever[i] & kHard);
    if (object.kind == "bush") {
      out.bushes_soft.count(ever[i] & kSoft);
      out.bushes_obstacle.count(ever[i] & kObstacle);
    }
    if (object.kind != "rock") continue;
    if (object.height_m >= kTallRock) {
      out.tall_rocks_hard.count(ever[i] & kHard);
      out.tall_rocks_obstacle.count(ever[i] & kObstacle);
    } else {
      out.low_rocks_obstacle.count(ever[i] & kObstacle);
    }
  }
}

Evaluation Evaluator::result() const {
  Evaluation out = sums_;
  out.height_lowest = summarize(error_lowest_);
  out.height_mean = summarize(error_mean_);
  out.near_height_lowest = summarize(near_error_lowest_);
  out.near_height_mean = summarize(near_error_mean_);
  out.branch_clearance = summarize(clearance_error_);
  count_columns(out);
  count_objects(out);
  return out;
}

std::vector<std::array<double, 2>> headings(const std::vector<FrameInfo>& frames) {
  std::vector<std::array<double, 2>> out;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameInfo& before = frames[i - std::min(i, kHeadingFrames)];
    const FrameInfo& after = frames[std::min(i + kHeadingFrames, frames.size() - 1)];
    out.push_back({after.base_m[0] - before.base_m[0], after.base_m[1] - before.base_m[1]});
  }
  return out;
}

}  // namespace gvom::truth
