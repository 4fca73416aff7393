#include "tools/evaluation/scene_facts.hpp"

#include <algorithm>
#include <limits>

#include "tools/sim/world.hpp"

namespace gvom::evaluation {
namespace {

constexpr double kThinnestTrunk_m = 0.075;  // radius
constexpr double kTrunkMargin_m = 0.05;
constexpr double kHalfStrip_m = 1.0;
constexpr double kAboveGround_m = 0.05;
constexpr double kBarMargin_m = 0.8;  // of a hole's rims
constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();

/// Calls `visit(column)` for columns of which some point lies within `radius_m` of `centre_m`.
template <typename Visit>
void for_each_touched(const Truth& truth, const Eigen::Vector2d& centre_m, double radius_m, Visit&& visit) {
  const double edge = truth.resolution_m;
  const auto first = [&](int axis) {
    return static_cast<std::int64_t>(std::floor((centre_m[axis] - radius_m) / edge));
  };
  const auto last = [&](int axis) {
    return static_cast<std::int64_t>(std::floor((centre_m[axis] + radius_m) / edge));
  };
  for (std::int64_t y = first(1); y <= last(1); ++y)
    for (std::int64_t x = first(0); x <= last(0); ++x) {
      const Eigen::Vector2d low(static_cast<double>(x) * edge, static_cast<double>(y) * edge);
      const Eigen::Vector2d nearest = centre_m.cwiseMax(low).cwiseMin(low + Eigen::Vector2d(edge, edge));
      if ((nearest - centre_m).norm() > radius_m) continue;
      const std::int64_t column = column_at(truth, low + 0.5 * Eigen::Vector2d(edge, edge));
      if (column >= 0) visit(static_cast<std::size_t>(column));
    }
}

bool is_solid(const sim::Body& body) {
  return std::isinf(body.hits_per_m);
}

/// Metres from the body's middle, in the plane, that it reaches at most.
double reach_m(const sim::Body& body) {
  if (body.shape == sim::Body::Shape::capsule) return 0.5 * body.size.head<2>().norm() + body.radius_m;
  if (body.shape == sim::Body::Shape::box) return body.size.head<2>().norm();
  return std::max(body.size.x(), body.size.y());
}

Eigen::Vector2d middle_of_body(const sim::Body& body) {
  const bool capsule = body.shape == sim::Body::Shape::capsule;
  return (capsule ? body.centre + 0.5 * body.size : body.centre).head<2>();
}

void mark_tree(const sim::Object& tree, SceneFacts& facts) {
  const double beside = facts.truth.resolution_m;
  const Eigen::Vector2d foot = tree.position_m.head<2>();
  for_each_touched(facts.truth, foot, tree.radius_m + beside,
                   [&](std::size_t column) { facts.trunk_beside[column] = 1; });
  for (const sim::Body& body : tree.bodies)
    if (!is_solid(body))
      for_each_touched(facts.truth, middle_of_body(body), reach_m(body) + beside,
                       [&](std::size_t column) { facts.crown_beside[column] = 1; });
  if (tree.radius_m < kThinnestTrunk_m) return;
  Trunk trunk{foot, tree.position_m.z(), tree.radius_m, {}};
  for_each_touched(facts.truth, foot, tree.radius_m + kTrunkMargin_m,
                   [&](std::size_t column) { trunk.columns.push_back(column); });
  if (!trunk.columns.empty()) facts.trunks.push_back(std::move(trunk));
}

void mark_path(const std::vector<Eigen::Vector2d>& path_m, SceneFacts& facts) {
  std::vector<double> nearest_m(facts.path_driven_m.size(), kHalfStrip_m);
  for (std::size_t i = 0; i < path_m.size(); ++i)
    for_each_touched(facts.truth, path_m[i], kHalfStrip_m, [&](std::size_t column) {
      const double distance_m = (middle_of(facts.truth, column) - path_m[i]).norm();
      if (distance_m >= nearest_m[column]) return;
      nearest_m[column] = distance_m;
      facts.path_driven_m[column] = static_cast<float>(static_cast<double>(i) * kPathStep_m);
    });
}

/// The columns of a lane in which something lethal keeps a vehicle out of the hole.
std::vector<std::size_t> bars_of(const Truth& truth, const Hole& hole, const Lane& lane) {
  const Eigen::Vector2d left(-hole.forward.y(), hole.forward.x());
  const double from_m = lane.rim_m - kBarMargin_m, to_m = lane.far_rim_m + kBarMargin_m;
  const Eigen::Vector2d centre_m =
      hole.rim_point_m + 0.5 * (from_m + to_m) * hole.forward + lane.offset_m * left;
  std::vector<std::size_t> columns;
  for_each_touched(truth, centre_m, 0.5 * (to_m - from_m) + kHalfStrip_m, [&](std::size_t column) {
    const Eigen::Vector2d way = middle_of(truth, column) - hole.rim_point_m;
    const double along_m = way.dot(hole.forward);
    if (along_m >= from_m && along_m <= to_m && std::abs(way.dot(left) - lane.offset_m) <= kHalfStrip_m)
      columns.push_back(column);
  });
  return columns;
}

/// The column of the frame, -1 where it does not reach.
std::int64_t in_frame(const Truth& truth, const Frame& frame, std::size_t column) {
  const std::int64_t x = static_cast<std::int64_t>(column) % truth.size_x + truth.origin[0] - frame.origin[0];
  const std::int64_t y = static_cast<std::int64_t>(column) / truth.size_x + truth.origin[1] - frame.origin[1];
  return x < 0 || y < 0 || x >= frame.size || y >= frame.size ? -1 : y * frame.size + x;
}

}  // namespace

SceneFacts find_facts(const sim::WorldData& world, const Truth& truth,
                      const std::vector<Eigen::Vector2d>& path_m) {
  const std::size_t columns = truth.classes.size();
  SceneFacts facts{world, truth, find_holes(world.ground, path_m), {}, {}, {}, {}, {}, {}};
  facts.path_driven_m.assign(columns, kNowhere);
  facts.trunk_beside.assign(columns, 0);
  facts.crown_beside.assign(columns, 0);
  for (const Hole& hole : facts.holes) {
    facts.bars.emplace_back();
    for (const Lane& lane : hole.lanes) facts.bars.back().push_back(bars_of(truth, hole, lane));
  }
  for (const sim::Object& object : world.objects) {
    if (object.kind == sim::Kind::tree) mark_tree(object, facts);
    if (object.kind == sim::Kind::walker && !object.track.empty()) facts.walkers.push_back(&object);
  }
  mark_path(path_m, facts);
  return facts;
}

Eigen::Vector2d place_at(const sim::Object& walker, double time_s) {
  const sim::TrackPoint place = sim::place_on(walker.track, time_s);
  return {place.x_m, place.y_m};
}

std::int64_t column_at(const Truth& truth, const Eigen::Vector2d& point_m) {
  const auto index = [&](int axis) {
    return static_cast<std::int64_t>(std::floor(point_m[axis] / truth.resolution_m)) - truth.origin[axis];
  };
  const std::int64_t x = index(0), y = index(1);
  return x < 0 || y < 0 || x >= truth.size_x || y >= truth.size_y ? -1 : y * truth.size_x + x;
}

Eigen::Vector2d middle_of(const Truth& truth, std::size_t column) {
  const auto x = static_cast<std::int64_t>(column) % truth.size_x + truth.origin[0];
  const auto y = static_cast<std::int64_t>(column) / truth.size_x + truth.origin[1];
  return {(static_cast<double>(x) + 0.5) * truth.resolution_m,
          (static_cast<double>(y) + 0.5) * truth.resolution_m};
}

std::uint8_t flags_at(const Truth& truth, const Frame& frame, std::size_t column) {
  const std::int64_t at = in_frame(truth, frame, column);
  return at < 0 ? std::uint8_t{0} : frame.flags[at];
}

std::uint8_t visibility_at(const Truth& truth, const Frame& frame, std::size_t column) {
  const std::int64_t at = in_frame(truth, frame, column);
  return at < 0 ? std::uint8_t{0} : frame.visibility[at];
}

bool ground_in_sight(const SceneFacts& facts, const Frame& frame, const Sight& sight, std::size_t column) {
  const Eigen::Vector2d middle_m = middle_of(facts.truth, column);
  const double height_m = facts.truth.ground_mean[column] + kAboveGround_m;
  return std::isinf(sight(frame.sensor_m, {middle_m.x(), middle_m.y(), height_m}));
}

bool is_behind_edge(const SceneFacts& facts, const Frame& frame, const Sight& sight, std::size_t column) {
  if (facts.holes.empty()) return false;
  const Eigen::Vector2d way = middle_of(facts.truth, column) - frame.base_m;
  const double step_m = facts.truth.resolution_m;
  for (double way_m = way.norm() - step_m; way_m > 0.0; way_m -= step_m) {
    const std::int64_t at = column_at(facts.truth, frame.base_m + way_m * way.normalized());
    if (at < 0 || facts.truth.drop_m[static_cast<std::size_t>(at)] < kShallowestHole_m) continue;
    return !ground_in_sight(facts, frame, sight, column);
  }
  return false;
}

}  // namespace gvom::evaluation
