// What people have built: walls and a street.
#include <algorithm>

#include "tools/sim/noise.hpp"
#include "tools/sim/scenes/ground.hpp"
#include "tools/sim/scenes/planter.hpp"
#include "tools/sim/scenes/scenes.hpp"
#include "tools/sim/scenes/things.hpp"

namespace gvom::sim {
namespace {

constexpr double kQuarterTurn = 1.5707963267948966;

constexpr double kRoadHalf = 4.0;
constexpr double kKerbHeight = 0.12;
constexpr double kKerbRun = 0.05;
constexpr double kKerbResolution = 0.05;
constexpr double kHouses = 7.0;
constexpr double kHouseDepth = 8.0;
constexpr double kParked = 2.9;  // the middle of a car, from the middle of the road
constexpr double kTaken = 0.45;  // share of the parking places
constexpr double kLamps = 4.5;

GroundPoint street_at(double y) {
  const double risen = std::clamp((std::abs(y) - kRoadHalf) / kKerbRun, 0.0, 1.0);
  GroundPoint point{kPlainHeight + kKerbHeight * risen};
  if (std::abs(std::abs(y) - kRoadHalf) < 0.75 * kKerbRun) point.surface = Surface::face;
  return point;
}

void build_houses(Planter& planter, Random& random, double end_x, double side) {
  double x = -kAround;
  while (x < end_x) {
    const double width = random.between(8.0, 14.0);
    const double front = kHouses + random.between(0.0, 0.6);
    const Eigen::Vector3d foot = planter.on_ground(x + 0.5 * width, side * (front + 0.5 * kHouseDepth));
    planter.add(make_wall(foot, {width, kHouseDepth, random.between(5.0, 8.0)}, 0.0));
    x += width + (random.between(0.0, 1.0) < 0.4 ? random.between(1.0, 3.0) : 0.0);
  }
}

void park_cars(Planter& planter, Random& random, double end_x, double side) {
  for (double x = -20.0 + random.between(0.0, 4.0); x < end_x; x += random.between(5.4, 7.0))
    if (random.between(0.0, 1.0) < kTaken)
      planter.add(make_car(planter.on_ground(x, side * (kParked + random.between(-0.1, 0.1)))));
}

}  // namespace

WorldData make_walls(const SceneParameters&) {
  const Course course = straight_course(kEndingPath);
  WorldData world = paint_world("wall", course, [](double, double) { return GroundPoint{}; });
  Planter planter(world, course);
  planter.add(make_wall(planter.on_ground(22.0, 4.0), {34.0, 0.3, 2.0}, 0.0));
  planter.add(make_wall(planter.on_ground(kEnd + 0.15, 0.0), {20.0, 0.3, 2.0}, kQuarterTurn));
  return world;
}

WorldData make_street(const SceneParameters& parameters) {
  const Course course = straight_course(parameters.length_m);
  WorldData world = paint_world(
      "street", course, [](double, double y) { return street_at(y); }, kKerbResolution);
  Planter planter(world, course);
  Random random(derive(parameters.seed, 0x57EE7));
  const double end = parameters.length_m + kAround;
  for (const double side : {-1.0, 1.0}) {
    build_houses(planter, random, end, side);
    park_cars(planter, random, end, side);
    for (double x = side > 0.0 ? 5.0 : 17.0; x < end; x += 24.0)
      planter.add(make_post(planter.on_ground(x, side * kLamps), 0.08));
  }
  return world;
}

}  // namespace gvom::sim
