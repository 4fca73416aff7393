#include "tools/sim/world.hpp"

#include <algorithm>
#include <cmath>

#include "tools/sim/noise.hpp"

namespace gvom::sim {
namespace {

constexpr double kAround = 52.0;     // truth beyond the driven trail: half of the paper's grid
constexpr double kMaxRange = 110.0;  // ground beyond the truth's end, for rays that go on
constexpr double kPatch = 10.0;      // length of trail planted at a time
constexpr double kSpacing = 1.0;     // free ground between two things

constexpr double kBranchX = 45.0;
constexpr double kBranchHeight = 2.7;
constexpr double kBranchRadius = 0.07;

constexpr double kPersonX = 38.0;
constexpr double kPersonSpeed = 1.4;
constexpr double kPersonRadius = 0.25;
constexpr double kPersonHeight = 1.8;
constexpr double kPersonAhead = 9.0;  // of the vehicle when in the middle of the trail

constexpr std::uint8_t kBark = 60;
constexpr std::uint8_t kLeaves = 30;
constexpr std::uint8_t kStone = 90;
constexpr std::uint8_t kCloth = 120;
constexpr std::uint8_t kSoil = 40;

Primitive capsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m,
                  std::uint8_t reflectivity, int object) {
  Primitive body;
  body.shape = Primitive::Shape::capsule;
  body.reflectivity = reflectivity;
  body.object = object;
  body.centre = from;
  body.size = to - from;
  body.radius_m = radius_m;
  return body;
}

Primitive ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, std::uint8_t reflectivity,
                    int object) {
  Primitive body;
  body.reflectivity = reflectivity;
  body.object = object;
  body.centre = centre;
  body.size = radii;
  return body;
}

Area grown(const Area& area, double by) {
  return {area.min_x_m - by, area.min_y_m - by, area.max_x_m + by, area.max_y_m + by};
}

}  // namespace

World::World(const WorldParameters& parameters)
    : landscape_(parameters.seed),
      truth_area_{-kAround, -kAround, parameters.length_m + kAround, kAround},
      terrain_(landscape_, grown(truth_area_, kMaxRange - kAround)),
      person_crossing_s_((kPersonX - kPersonAhead) / parameters.speed_mps) {
  add_branch();
  // Each patch has its own stream, so that a longer drive goes through the same woods.
  const int first = static_cast<int>(std::floor(truth_area_.min_x_m / kPatch));
  const int last = static_cast<int>(std::ceil(truth_area_.max_x_m / kPatch));
  for (int patch = first; patch < last; ++patch)
    plant(patch * kPatch, derive(parameters.seed, static_cast<std::uint64_t>(patch + 1'000'000)));
  bins_ = BinGrid(primitives_);
}

void World::plant(double from_x_m, std::uint64_t seed) {
  Random random(seed);
  const auto patch = [&](int count, double nearest_m, double farthest_m, auto add) {
    for (int i = 0; i < count; ++i) {
      const double x = from_x_m + random.between(0.0, kPatch);
      const double side = random.between(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
      const double y = landscape_.trail_y_m(x) + side * random.between(nearest_m, farthest_m);
      if (is_free(x, y)) (this->*add)(random, x, y);
    }
  };
  patch(4, 4.0, 14.0, &World::add_tree);
  patch(4, 10.0, 45.0, &World::add_tree);
  patch(3, 3.2, 9.0, &World::add_bush);
  patch(3, 6.0, 30.0, &World::add_bush);
  patch(3, 2.8, 12.0, &World::add_rock);
}

bool World::is_free(double x_m, double y_m) const {
  const TrailFrame ditch = landscape_.relative_to(kDitchX, x_m, y_m);
  if (std::abs(ditch.along_m) < 2.5 && std::abs(ditch.left_m) < 16.0) return false;
  const TrailFrame step = landscape_.relative_to(kStepX, x_m, y_m);
  if (std::abs(step.along_m) < 8.0 && step.left_m > 2.0 && step.left_m < 19.0) return false;
  const double lateral = std::abs(y_m - landscape_.trail_y_m(x_m));
  if (std::abs(x_m - kPersonX) < 2.0 && lateral < 10.0) return false;
  if (std::abs(x_m - kBranchX) < 2.5 && lateral < 6.0) return false;
  return std::none_of(objects_.begin(), objects_.end(), [&](const Object& other) {
    const double distance = std::hypot(other.position_m.x() - x_m, other.position_m.y() - y_m);
    return distance < other.radius_m + kSpacing;
  });
}

Eigen::Vector3d World::on_ground(double x_m, double y_m) const {
  return {x_m, y_m, terrain_.height_m(x_m, y_m)};
}

void World::add_tree(Random& random, double x_m, double y_m) {
  const int number = static_cast<int>(objects_.size());
  const Eigen::Vector3d foot = on_ground(x_m, y_m);
  const double radius = random.between(0.15, 0.30);
  const double height = random.between(4.0, 8.0);
  objects_.push_back({"tree", foot, radius, height});
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  primitives_.push_back(capsule(foot - 0.5 * up, foot + 0.8 * height * up, radius, kBark, number));

  const double crown_bottom = std::max(2.6, 0.45 * height);
  const double half = 0.5 * (height - crown_bottom);
  const double spread = random.between(0.9, 1.6);
  Primitive crown = ellipsoid(foot + (crown_bottom + half) * up, {spread, spread, half}, kLeaves, number);
  crown.absorption_per_m = random.between(0.10, 0.25);
  primitives_.push_back(crown);
}

void World::add_bush(Random& random, double x_m, double y_m) {
  const int number = static_cast<int>(objects_.size());
  const Eigen::Vector3d radii(random.between(0.5, 1.2), random.between(0.5, 1.2), random.between(0.5, 1.0));
  const Eigen::Vector3d centre = on_ground(x_m, y_m) + Eigen::Vector3d(0.0, 0.0, 0.6 * radii.z());
  Primitive leaves = ellipsoid(centre, radii, kLeaves, number);
  leaves.absorption_per_m = random.between(0.6, 1.2);
  primitives_.push_back(leaves);
  objects_.push_back({"bush", on_ground(x_m, y_m), std::max(radii.x(), radii.y()), 1.6 * radii.z()});
}

void World::add_rock(Random& random, double x_m, double y_m) {
  const int number = static_cast<int>(objects_.size());
  const double radius = random.between(0.3, 0.6);
  const bool tall = random.between(0.0, 1.0) < 0.4;
  const double height = tall ? random.between(0.9, 1.4) : radius;
  const Eigen::Vector3d foot = on_ground(x_m, y_m);
  primitives_.push_back(ellipsoid(foot, {radius, radius, height}, kStone, number));
  objects_.push_back({"rock", foot, radius, height});
}

void World::add_branch() {
  const double middle = landscape_.trail_y_m(kBranchX);
  const double ground = terrain_.height_m(kBranchX, middle);
  const Eigen::Vector3d foot = on_ground(kBranchX, middle + 3.4);
  const int number = static_cast<int>(objects_.size());
  objects_.push_back({"tree", foot, 0.22, 6.0});
  primitives_.push_back(
      capsule(foot - Eigen::Vector3d(0, 0, 0.5), foot + Eigen::Vector3d(0, 0, 6.0), 0.22, kBark, number));

  const Eigen::Vector3d root(kBranchX, middle + 3.4, ground + kBranchHeight + 0.3);
  const Eigen::Vector3d tip(kBranchX + 0.6, middle - 3.2, ground + kBranchHeight + kBranchRadius);
  objects_.push_back({"branch", on_ground(kBranchX, middle), kBranchRadius, kBranchHeight});
  primitives_.push_back(capsule(root, tip, kBranchRadius, kBark, number + 1));
  for (int twig = 1; twig <= 8; ++twig) {
    const Eigen::Vector3d joint = root + twig / 9.0 * (tip - root);
    const Eigen::Vector3d reach(twig % 2 == 0 ? 0.7 : -0.7, -0.3, 0.25);
    primitives_.push_back(capsule(joint, joint + reach, 0.02, kBark, number + 1));
  }
}

Primitive World::person_at(double time_s) const {
  const double y = landscape_.trail_y_m(kPersonX) + kPersonSpeed * (time_s - person_crossing_s_);
  const Eigen::Vector3d foot = on_ground(kPersonX, y);
  return capsule(foot + Eigen::Vector3d(0, 0, kPersonRadius),
                 foot + Eigen::Vector3d(0, 0, kPersonHeight - kPersonRadius), kPersonRadius, kCloth, -1);
}

Hit World::cast(const Ray& ray, const Primitive& person, double max_range_m, std::uint64_t key) const {
  Hit hit{terrain_.intersect(ray, max_range_m), kSoil};
  double limit = std::min(hit.range_m, max_range_m);
  const auto meet = [&](const Primitive& body, std::uint64_t number) {
    const Interval inside = intersect(body, ray);
    if (inside.empty() || inside.leave < 0.0 || inside.enter >= limit) return;
    double at = std::max(inside.enter, 0.0);
    if (!body.is_solid()) {
      at -= std::log(1.0 - uniform(derive(key, number))) / body.absorption_per_m;
      if (at > inside.leave) return;
    }
    if (at >= limit) return;
    limit = at;
    hit = {at, body.reflectivity};
  };
  bins_.walk(ray, limit, [&](int number) { meet(primitives_[number], static_cast<std::uint64_t>(number)); });
  meet(person, 0);
  return hit;
}

}  // namespace gvom::sim
