// What hangs or walks across the path.
#include "tools/sim/noise.hpp"
#include "tools/sim/scenes/ground.hpp"
#include "tools/sim/scenes/planter.hpp"
#include "tools/sim/scenes/scenes.hpp"
#include "tools/sim/scenes/things.hpp"

namespace gvom::sim {
namespace {

constexpr double kHighBranchX = 18.0;
constexpr double kHighBranch = 2.5;
constexpr double kLowBranch = 1.2;
constexpr double kBranchTree = 3.4;  // from the trail to the tree it grows on
constexpr double kBranchRadius = 0.06;

constexpr double kWalkingMps = 1.4;
constexpr double kCrossingX = 22.0;
constexpr double kAhead = 10.0;  // of the vehicle, when in the middle of its path
constexpr double kBesideM = 2.5;

void add_branch(Planter& planter, Random& random, double x_m, double height_m) {
  planter.add(make_tree(random, planter.on_ground(x_m, kBranchTree), {0.2, 4.0, 1.6, 7.0}));
  planter.add(make_branch(
      {planter.on_ground(x_m, 0.0), {x_m, kBranchTree}, {x_m + 0.4, -3.2}, kBranchRadius, height_m}));
}

}  // namespace

WorldData make_branches(const SceneParameters& parameters) {
  const Course course = straight_course(kEndingPath);
  WorldData world = paint_world("branches", course, [](double, double) { return GroundPoint{}; });
  Planter planter(world, course);
  Random random(derive(parameters.seed, 0xB4A));
  add_branch(planter, random, kHighBranchX, kHighBranch);
  add_branch(planter, random, kEnd, kLowBranch);
  planter.trees(random, 40, {4.0, 30.0, 1.5});
  return world;
}

WorldData make_walkers(const SceneParameters& parameters) {
  const Course course = straight_course(parameters.length_m);
  WorldData world = paint_world("walker", course, [](double, double) { return GroundPoint{}; });
  Planter planter(world, course);
  Random random(derive(parameters.seed, 0x3A1));
  const double crossing_s = (kCrossingX - kAhead) / parameters.speed_mps;
  const double begin_y = -kWalkingMps * crossing_s, end_y = 12.0;
  planter.add(
      make_walker(planter.on_ground(kCrossingX, begin_y),
                  {{0.0, kCrossingX, begin_y}, {crossing_s + end_y / kWalkingMps, kCrossingX, end_y}}));
  planter.add(make_walker(planter.on_ground(8.0, kBesideM),
                          {{0.0, 8.0, kBesideM}, {20.0, 8.0 + 20.0 * kWalkingMps, kBesideM}}));
  planter.trees(random, 30, {16.0, 40.0, 1.5});
  return world;
}

}  // namespace gvom::sim
