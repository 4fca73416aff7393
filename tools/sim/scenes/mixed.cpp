// All difficulties in one drive.
#include <algorithm>
#include <cmath>

#include "tools/sim/noise.hpp"
#include "tools/sim/scenes/ground.hpp"
#include "tools/sim/scenes/planter.hpp"
#include "tools/sim/scenes/scenes.hpp"
#include "tools/sim/scenes/things.hpp"

namespace gvom::sim {
namespace {

constexpr double kTrailHalf = 1.5;
constexpr double kDitchX = 30.0;
constexpr double kDitchReach = 9.0;  // to each side
constexpr double kPuddleX = 16.0;
constexpr double kPuddleShore = 1.5;  // from the water's edge to untouched ground
constexpr double kCrossingX = 46.0;
constexpr double kAhead = 10.0;
constexpr double kWalkingMps = 1.4;

/// Rolling ground with a ditch across the trail and water beside it, level and with gentle shores.
struct MixedGround {
  Relief relief;
  Ditch ditch;
  Patch puddle;

  [[nodiscard]] GroundPoint at(double x, double y) const {
    const double land = relief.height_m(x, y);
    const double water = relief.height_m(puddle.middle_m.x(), puddle.middle_m.y());
    const double ashore = (Eigen::Vector2d(x, y) - puddle.middle_m).norm() - 1.7 * puddle.radius_m;
    const double part = std::clamp(ashore / kPuddleShore, 0.0, 1.0);
    GroundPoint point = dug(water + part * part * (3.0 - 2.0 * part) * (land - water), ditch.depth_at(x, y));
    if (puddle.covers(x, y)) point.surface = Surface::mirror;
    return point;
  }
};

MixedGround shape_ground(Random& random, std::uint64_t seed, const Course& course) {
  Ditch ditch;
  ditch.middle_m = {kDitchX + 1.0, y_on(course.trail_m, kDitchX + 1.0)};
  ditch.half_length_m = kDitchReach;
  ditch.turned_rad = random.between(-0.25, 0.25);
  const double side = random.between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
  const Patch puddle{{kPuddleX, y_on(course.trail_m, kPuddleX) + side * random.between(2.0, 4.0)},
                     random.between(0.6, 1.2)};
  return {Relief(seed, course, {0.2, 12.0, 50.0}), ditch, puddle};
}

void keep_free(Planter& planter, const MixedGround& ground, const Course& course) {
  for (double along = -kDitchReach; along <= kDitchReach; along += 1.0)
    planter.keep_free(ground.ditch.middle_m + Eigen::Vector2d(-0.25 * along, along), 3.5);
  planter.keep_free(ground.puddle.middle_m, 1.7 * ground.puddle.radius_m);
  for (double beside = -10.0; beside <= 10.0; beside += 1.0)
    planter.keep_free({kCrossingX, y_on(course.trail_m, kCrossingX) + beside}, 1.0);
}

void plant_woods(Planter& planter, Random& random) {
  for (double x = -40.0; x < 110.0; x += 30.0) {
    const double begin = x + random.between(0.0, 10.0);
    const Strip patch{kTrailHalf, 35.0, 1.0, begin, begin + random.between(10.0, 15.0)};
    planter.trees(random, planter.count_for(patch, 18.0), patch);
  }
}

}  // namespace

WorldData make_mixed(const SceneParameters& parameters) {
  const Course course = winding_course(parameters.length_m, 2.5);
  Random random(derive(parameters.seed, 0x314ED));
  const MixedGround ground = shape_ground(random, parameters.seed, course);
  WorldData world = paint_world("mixed", course, [&](double x, double y) { return ground.at(x, y); });
  Planter planter(world, course);
  keep_free(planter, ground, course);
  plant_woods(planter, random);
  const Strip beside{kTrailHalf, 25.0, 1.0};
  planter.rocks(random, planter.count_for(beside, 150.0), beside);
  planter.bushes(random, planter.count_for(beside, 80.0), beside);
  for (const double x : {6.0, 52.0})
    planter.grass(random, {x, y_on(course.trail_m, x) + random.between(-7.0, 7.0)}, 4.0, kTrailHalf);

  const double crossing_s = (kCrossingX - kAhead) / parameters.speed_mps;
  const double trail_y = y_on(course.trail_m, kCrossingX);
  const double begin_y = trail_y - kWalkingMps * crossing_s;
  planter.add(
      make_walker(planter.on_ground(kCrossingX, begin_y),
                  {{0.0, kCrossingX, begin_y}, {2.0 * crossing_s, kCrossingX, 2.0 * trail_y - begin_y}}));
  return world;
}

}  // namespace gvom::sim
