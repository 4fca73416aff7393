#include "tools/sim/scenes/planter.hpp"

#include <algorithm>
#include <cmath>

#include "tools/sim/scenes/ground.hpp"
#include "tools/sim/scenes/things.hpp"

namespace gvom::sim {
namespace {

constexpr int kTriesPerThing = 20;
constexpr double kTussockSpacing = 1.0;
constexpr double kTussockRadius = 0.75;

}  // namespace

Eigen::Vector3d Planter::on_ground(double x_m, double y_m) const {
  return {x_m, y_m, quantised(height_at(world_.ground, x_m, y_m))};
}

double Planter::from_trail_m(double x_m, double y_m) const {
  return distance_to(course_.trail_m, {x_m, y_m});
}

bool Planter::is_free(const Eigen::Vector2d& place_m, double radius_m, double spacing_m) const {
  return std::none_of(taken_.begin(), taken_.end(), [&](const Footprint& other) {
    const double reach = other.radius_m + radius_m + spacing_m;
    return (other.place_m - place_m).squaredNorm() < reach * reach;
  });
}

void Planter::scatter(Random& random, int count, const Strip& strip,
                      const std::function<double()>& draw_radius,
                      const std::function<void(const Eigen::Vector3d& foot, double radius_m)>& make) {
  const double end = std::min(strip.to_x_m, course_.path_m.back().x() + kAround);
  int tries = count * kTriesPerThing;
  while (count > 0 && tries-- > 0) {
    const double radius = draw_radius();
    const double x = quantised(random.between(strip.from_x_m, end));
    const double y =
        quantised(y_on(course_.trail_m, x) + random.between(-strip.farthest_m, strip.farthest_m));
    if (from_trail_m(x, y) < strip.nearest_m + radius || !is_free({x, y}, radius, strip.spacing_m)) continue;
    keep_free({x, y}, radius);
    make(on_ground(x, y), radius);
    --count;
  }
}

int Planter::count_for(const Strip& strip, double m2_per_thing) const {
  const double length = std::min(strip.to_x_m, course_.path_m.back().x() + kAround) - strip.from_x_m;
  return static_cast<int>(2.0 * (strip.farthest_m - strip.nearest_m) * length / m2_per_thing);
}

void Planter::add(Object object) {
  keep_free(object.position_m.head<2>(), object.radius_m);
  world_.objects.push_back(std::move(object));
}

void Planter::trees(Random& random, int count, const Strip& strip) {
  scatter(
      random, count, strip, [&] { return random.between(0.05, 0.3); },
      [&](const Eigen::Vector3d& foot, double radius) {
        world_.objects.push_back(make_tree(random, foot, draw_tree(random, radius)));
      });
}

void Planter::bushes(Random& random, int count, const Strip& strip) {
  scatter(
      random, count, strip, [&] { return random.between(0.5, 1.4); },
      [&](const Eigen::Vector3d& foot, double radius) {
        const double height = std::min(1.8, radius * random.between(1.0, 1.6));
        world_.objects.push_back(make_bush(random, foot, radius, std::max(0.6, height)));
      });
}

void Planter::rocks(Random& random, int count, const Strip& strip) {
  scatter(
      random, count, strip, [&] { return random.between(0.3, 0.8); },
      [&](const Eigen::Vector3d& foot, double radius) {
        const double height = std::clamp(radius * random.between(0.7, 1.5), 0.3, 1.0);
        world_.objects.push_back(make_rock(random, foot, radius, height));
      });
}

void Planter::grass(Random& random, const Eigen::Vector2d& middle_m, double radius_m, double nearest_m) {
  Object field = make_grass(on_ground(middle_m.x(), middle_m.y()), radius_m);
  for (double dy = -radius_m; dy <= radius_m; dy += kTussockSpacing)
    for (double dx = -radius_m; dx <= radius_m; dx += kTussockSpacing) {
      const double x = quantised(middle_m.x() + dx + random.between(-0.3, 0.3));
      const double y = quantised(middle_m.y() + dy + random.between(-0.3, 0.3));
      const double height = random.between(0.4, 0.9);
      if (std::hypot(dx, dy) > radius_m || from_trail_m(x, y) < nearest_m + kTussockRadius) continue;
      add_tussock(field, on_ground(x, y), kTussockRadius, height);
    }
  if (!field.bodies.empty()) world_.objects.push_back(std::move(field));
}

}  // namespace gvom::sim
