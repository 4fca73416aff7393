// What deceives or blinds a lidar on easy ground.
#include <algorithm>

#include "tools/sim/materials.hpp"
#include "tools/sim/noise.hpp"
#include "tools/sim/scenes/ground.hpp"
#include "tools/sim/scenes/planter.hpp"
#include "tools/sim/scenes/scenes.hpp"
#include "tools/sim/scenes/things.hpp"

namespace gvom::sim {
namespace {

std::vector<Patch> draw_patches(Random& random, double end_x) {
  std::vector<Patch> patches;
  for (double x = 7.0; x < end_x; x += 5.0) {
    const bool on_path = patches.size() % 3 == 0;
    const double radius = random.between(0.5, 1.6);
    const double side = random.between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
    const double y = on_path ? random.between(-0.5, 0.5) : side * random.between(2.0, 8.0);
    patches.push_back({{x + random.between(-1.0, 1.0), y}, radius, random.between(0.0, 6.28)});
  }
  return patches;
}

/// Flat ground with patches of `surface`, and trees and rocks that are seen in them or behind them.
WorldData make_patchy(const char* name, const SceneParameters& parameters, Surface surface) {
  const Course course = straight_course(parameters.length_m);
  Random random(derive(parameters.seed, 0x9A7C));
  const std::vector<Patch> patches = draw_patches(random, parameters.length_m + 30.0);
  WorldData world = paint_world(name, course, [&](double x, double y) {
    const auto covers = [&](const Patch& patch) { return patch.covers(x, y); };
    const bool covered = std::any_of(patches.begin(), patches.end(), covers);
    return GroundPoint{kPlainHeight, covered ? surface : Surface::ground};
  });
  Planter planter(world, course);
  for (const Patch& patch : patches) planter.keep_free(patch.middle_m, 1.7 * patch.radius_m);
  planter.trees(random, 50, {2.5, 12.0, 1.5});
  planter.trees(random, 60, {12.0, 35.0, 1.5});
  planter.rocks(random, 20, {2.5, 15.0, 1.0});
  return world;
}

WorldData paint_meadow(const char* name, const SceneParameters& parameters, const Course& course) {
  const Relief relief(derive(parameters.seed, 0x3EAD), course, {0.08, 15.0, 50.0});
  return paint_world(name, course, [&](double x, double y) { return GroundPoint{relief.height_m(x, y)}; });
}

}  // namespace

WorldData make_puddles(const SceneParameters& parameters) {
  return make_patchy("puddles", parameters, Surface::mirror);
}

WorldData make_dark(const SceneParameters& parameters) {
  return make_patchy("dark", parameters, Surface::dark);
}

WorldData make_dusty(const SceneParameters& parameters) {
  const Course course = straight_course(parameters.length_m);
  WorldData world = paint_meadow("dust", parameters, course);
  Planter planter(world, course);
  Random random(derive(parameters.seed, 0xD057));
  planter.trees(random, 60, {3.0, 35.0, 1.5});
  for (double x = -6.0; x < parameters.length_m + 20.0; x += random.between(6.0, 10.0)) {
    const Eigen::Vector3d radii(random.between(2.0, 5.0), random.between(1.5, 4.0), random.between(0.8, 1.8));
    const Eigen::Vector3d foot = planter.on_ground(x, random.between(-4.0, 4.0));
    world.objects.push_back(make_dust(foot + Eigen::Vector3d(0.0, 0.0, 0.8 * radii.z()), radii,
                                      random.between(kThinDust, kDenseDust)));
  }
  return world;
}

WorldData make_rain(const SceneParameters& parameters) {
  const Course course = straight_course(parameters.length_m);
  WorldData world = paint_meadow("rain", parameters, course);
  world.rain_hits_per_m = kRain;
  Planter planter(world, course);
  Random random(derive(parameters.seed, 0x4A14));
  planter.trees(random, 60, {3.0, 35.0, 1.5});
  planter.bushes(random, 30, {2.0, 20.0});
  return world;
}

}  // namespace gvom::sim
