// What grows and lies about on rolling ground.
#include "tools/sim/noise.hpp"
#include "tools/sim/scenes/ground.hpp"
#include "tools/sim/scenes/planter.hpp"
#include "tools/sim/scenes/scenes.hpp"
#include "tools/sim/scenes/things.hpp"

namespace gvom::sim {
namespace {

constexpr double kTrailHalf = 1.5;
constexpr double kM2PerTree = 13.5;
constexpr double kHiddenFeet = 0.4;  // of the trees
constexpr double kLowCrowns = 0.3;   // of the trees of forest-low
constexpr double kLowestLeaves = 1.3;
constexpr double kSwing = 2.0;

WorldData paint_rolling(const char* name, std::uint64_t seed, const Course& course, double steepest) {
  const Relief relief(seed, course, {steepest, 12.0, 50.0});
  return paint_world(name, course, [&](double x, double y) { return GroundPoint{relief.height_m(x, y)}; });
}

/// A bush or some grass around the foot of a trunk, unless the trail is too near.
void hide_foot(Planter& planter, WorldData& world, Random& random, const Eigen::Vector3d& foot) {
  const double radius = random.between(0.4, 0.8);
  const double height = random.between(0.5, 1.0);
  const bool bush = random.between(0.0, 1.0) < 0.5;
  if (planter.from_trail_m(foot.x(), foot.y()) < kTrailHalf + radius) return;
  if (bush) {
    world.objects.push_back(make_bush(random, foot, radius, height));
  } else {
    Object grass = make_grass(foot, radius);
    add_tussock(grass, foot, radius, height);
    world.objects.push_back(std::move(grass));
  }
}

/// `low_crowns`: the share of the trees whose leaves hang down to 1.3 m, none of them over the trail.
WorldData make_woods(const char* name, const SceneParameters& parameters, double low_crowns) {
  const Course course = winding_course(parameters.length_m, kSwing);
  WorldData world = paint_rolling(name, derive(parameters.seed, 0xF04E), course, 0.15);
  Planter planter(world, course);
  Random random(derive(parameters.seed, 0xF04E57));
  const Strip woods{kTrailHalf, 50.0, 1.0};
  planter.scatter(
      random, planter.count_for(woods, kM2PerTree), woods, [&] { return random.between(0.05, 0.3); },
      [&](const Eigen::Vector3d& foot, double radius) {
        TreeShape shape = draw_tree(random, radius);
        const bool reaches_trail =
            planter.from_trail_m(foot.x(), foot.y()) < kTrailHalf + shape.crown_radius_m;
        if (random.between(0.0, 1.0) < low_crowns && !reaches_trail) shape.crown_bottom_m = kLowestLeaves;
        world.objects.push_back(make_tree(random, foot, shape));
        if (random.between(0.0, 1.0) < kHiddenFeet) hide_foot(planter, world, random, foot);
      });
  return world;
}

}  // namespace

WorldData make_forest(const SceneParameters& parameters) {
  return make_woods("forest", parameters, 0.0);
}

WorldData make_forest_low(const SceneParameters& parameters) {
  return make_woods("forest-low", parameters, kLowCrowns);
}

WorldData make_bushes(const SceneParameters& parameters) {
  const Course course = winding_course(parameters.length_m, kSwing);
  WorldData world = paint_rolling("bushes", derive(parameters.seed, 0xB057), course, 0.2);
  Planter planter(world, course);
  Random random(derive(parameters.seed, 0xB05));
  const Strip near{kTrailHalf, 15.0}, far{15.0, 50.0};
  planter.bushes(random, planter.count_for(near, 20.0), near);
  planter.bushes(random, planter.count_for(far, 60.0), far);
  return world;
}

WorldData make_grass_fields(const SceneParameters& parameters) {
  const Course course = winding_course(parameters.length_m, kSwing);
  WorldData world = paint_rolling("grass", derive(parameters.seed, 0x64A5), course, 0.15);
  Planter planter(world, course);
  Random random(derive(parameters.seed, 0x64A55));
  for (double x = 4.0; x < parameters.length_m + 30.0; x += 10.0) {
    const double y = y_on(course.trail_m, x);
    const bool on_trail = random.between(0.0, 1.0) < 0.4;
    const double left = y + random.between(5.0, 9.0), right = y - random.between(5.0, 9.0);
    planter.grass(random, {x + random.between(-2.0, 2.0), left}, random.between(4.0, 6.0), kTrailHalf);
    planter.grass(random, {x + random.between(-2.0, 2.0), right}, random.between(4.0, 6.0), kTrailHalf);
    if (on_trail) planter.grass(random, {x, y}, 2.5, -kTrailHalf);
  }
  return world;
}

WorldData make_rocks(const SceneParameters& parameters) {
  const Course course = winding_course(parameters.length_m, kSwing);
  WorldData world = paint_rolling("rocks", derive(parameters.seed, 0x40C5), course, 0.15);
  Planter planter(world, course);
  Random random(derive(parameters.seed, 0x40C5));
  const Strip near{kTrailHalf, 12.0, 1.0}, far{12.0, 50.0, 1.0};
  planter.rocks(random, planter.count_for(near, 25.0), near);
  planter.rocks(random, planter.count_for(far, 120.0), far);
  for (double x = 10.0; x < parameters.length_m; x += 15.0) {
    const double side = random.between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
    planter.grass(random, {x, y_on(course.trail_m, x) + 5.0 * side}, 3.5, kTrailHalf);
  }
  return world;
}

}  // namespace gvom::sim
