#include "tools/sim/scenes/things.hpp"

#include <algorithm>
#include <cmath>

#include "tools/sim/materials.hpp"
#include "tools/sim/scenes/course.hpp"

namespace gvom::sim {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr double kRoots = 0.5;  // trunks and walls go as deep into the ground, so that none hangs on a slope

constexpr double kCarLength = 4.4;
constexpr double kCarWidth = 1.8;
constexpr double kCarGap = 0.2;
constexpr double kCarWaist = 0.85;
constexpr double kCarHeight = 1.45;
constexpr double kWheelRadius = 0.31;
constexpr double kPostHeight = 5.0;

constexpr double kWalkerRadius = 0.25;
constexpr double kWalkerHeight = 1.8;

Eigen::Vector3d up(double height_m) {
  return {0.0, 0.0, height_m};
}

/// Horizontal, in a direction that is drawn.
Eigen::Vector3d draw_direction(Random& random) {
  const double angle = random.between(0.0, kTurn);
  return {quantised(std::cos(angle)), quantised(std::sin(angle)), 0.0};
}

Body capsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m,
             std::uint8_t reflectivity) {
  Body body;
  body.shape = Body::Shape::capsule;
  body.centre = from;
  body.size = to - from;
  body.radius_m = radius_m;
  body.reflectivity = reflectivity;
  return body;
}

Body ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii_m, std::uint8_t reflectivity) {
  Body body;
  body.centre = centre;
  body.size = radii_m;
  body.reflectivity = reflectivity;
  return body;
}

Body porous(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii_m, double hits_per_m) {
  Body body = ellipsoid(centre, radii_m, kLeaves);
  body.hits_per_m = hits_per_m;
  return body;
}

Body box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, std::uint8_t reflectivity) {
  Body body;
  body.shape = Body::Shape::box;
  body.centre = 0.5 * (low + high);
  body.size = 0.5 * (high - low);
  body.reflectivity = reflectivity;
  return body;
}

Object object(Kind kind, const Eigen::Vector3d& foot, double radius_m, double height_m) {
  return {kind, foot, radius_m, height_m, {}, {}};
}

}  // namespace

TreeShape draw_tree(Random& random, double trunk_radius_m) {
  TreeShape shape{};
  shape.trunk_radius_m = trunk_radius_m;
  shape.crown_bottom_m = random.between(2.5, 2.8 + 4.0 * trunk_radius_m);
  shape.crown_radius_m = 0.7 + 4.5 * trunk_radius_m + random.between(0.0, 0.3);
  shape.height_m = shape.crown_bottom_m + 1.5 + 12.0 * trunk_radius_m + random.between(0.0, 1.0);
  return shape;
}

Object make_tree(Random& random, const Eigen::Vector3d& foot, const TreeShape& shape) {
  Object tree = object(Kind::tree, foot, shape.trunk_radius_m, shape.height_m);
  const double half = 0.5 * (shape.height_m - shape.crown_bottom_m);
  const Eigen::Vector3d fork = foot + up(shape.crown_bottom_m + 0.3 * half);
  tree.bodies.push_back(capsule(foot - up(kRoots), fork, shape.trunk_radius_m, kBark));
  tree.bodies.push_back(capsule(fork, fork + up(1.2 * half), 0.5 * shape.trunk_radius_m, kBark));

  // Two lobes to two sides of the trunk, each with a limb in it; both end at the crown's bottom and radius.
  const Eigen::Vector3d side = 0.35 * shape.crown_radius_m * draw_direction(random);
  const double spread = 0.65 * shape.crown_radius_m;
  for (const double sign : {1.0, -1.0}) {
    const double drawn_half = sign > 0.0 ? half : random.between(0.6, 0.9) * half;
    const Eigen::Vector3d centre = foot + sign * side + up(shape.crown_bottom_m + drawn_half);
    tree.bodies.push_back(porous(centre, {spread, spread, drawn_half}, kCrown));
    tree.bodies.push_back(capsule(fork, centre, 0.3 * shape.trunk_radius_m, kBark));
  }
  return tree;
}

Object make_bush(Random& random, const Eigen::Vector3d& foot, double radius_m, double height_m) {
  Object bush = object(Kind::bush, foot, radius_m, height_m);
  const double hits_per_m = random.between(kThinBush, kDenseBush);
  const Eigen::Vector3d side = 0.4 * radius_m * draw_direction(random);
  const double spread = 0.6 * radius_m;
  for (const double sign : {1.0, -1.0}) {
    const double top = sign > 0.0 ? height_m : random.between(0.6, 0.9) * height_m;
    bush.bodies.push_back(
        porous(foot + sign * side + up(0.45 * top), {spread, spread, 0.55 * top}, hits_per_m));
  }
  return bush;
}

Object make_rock(Random& random, const Eigen::Vector3d& foot, double radius_m, double height_m) {
  Object rock = object(Kind::rock, foot, radius_m, height_m);
  Body stone = ellipsoid(foot, {radius_m, random.between(0.65, 1.0) * radius_m, height_m}, kStone);
  stone.yaw_rad = quantised(random.between(0.0, kTurn));
  rock.bodies.push_back(stone);
  return rock;
}

Object make_grass(const Eigen::Vector3d& middle, double radius_m) {
  return object(Kind::grass, middle, radius_m, 0.0);
}

void add_tussock(Object& grass, const Eigen::Vector3d& foot, double radius_m, double height_m) {
  grass.bodies.push_back(porous(foot, {radius_m, radius_m, height_m}, kTallGrass));
  grass.height_m = std::max(grass.height_m, height_m);
}

Object make_wall(const Eigen::Vector3d& foot, const Eigen::Vector3d& size_m, double yaw_rad) {
  Object wall = object(Kind::wall, foot, 0.5 * std::hypot(size_m.x(), size_m.y()), size_m.z());
  const Eigen::Vector3d half(0.5 * size_m.x(), 0.5 * size_m.y(), 0.0);
  wall.bodies.push_back(box(foot - half - up(kRoots), foot + half + up(size_m.z()), kMasonry));
  wall.bodies.back().yaw_rad = yaw_rad;
  return wall;
}

Object make_car(const Eigen::Vector3d& foot) {
  Object car = object(Kind::car, foot, 0.5 * std::hypot(kCarLength, kCarWidth), kCarHeight);
  const auto part = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high, std::uint8_t reflectivity) {
    car.bodies.push_back(box(foot + low, foot + high, reflectivity));
  };
  const double length = 0.5 * kCarLength, width = 0.5 * kCarWidth;
  part({-length, -width, kCarGap}, {length, width, kCarWaist}, kPaint);
  part({-0.75 * length, 0.1 - width, kCarWaist}, {0.4 * length, width - 0.1, kCarHeight}, kPaint);
  for (const double x : {-1.35, 1.35})
    for (const double y : {-width + 0.1, width - 0.1})
      part({x - kWheelRadius, y - 0.1, 0.0}, {x + kWheelRadius, y + 0.1, 2.0 * kWheelRadius}, kTyre);
  return car;
}

Object make_post(const Eigen::Vector3d& foot, double radius_m) {
  Object post = object(Kind::tree, foot, radius_m, kPostHeight);
  post.bodies.push_back(capsule(foot - up(kRoots), foot + up(kPostHeight - radius_m), radius_m, kPaint));
  return post;
}

Object make_branch(const BranchShape& shape) {
  constexpr int kTwigs = 8;
  constexpr double kTwigRadius = 0.02;
  Object branch = object(Kind::branch, shape.foot, shape.radius_m, shape.height_m);
  const double axis = shape.foot.z() + shape.height_m + shape.radius_m;
  const Eigen::Vector3d root(shape.root_m.x(), shape.root_m.y(), axis + 0.3);
  const Eigen::Vector3d tip(shape.tip_m.x(), shape.tip_m.y(), axis);
  branch.bodies.push_back(capsule(root, tip, shape.radius_m, kBark));
  for (int twig = 1; twig <= kTwigs; ++twig) {
    const Eigen::Vector3d joint = root + twig / (kTwigs + 1.0) * (tip - root);
    const Eigen::Vector3d reach(twig % 2 == 0 ? 0.7 : -0.7, -0.3, 0.25);
    branch.bodies.push_back(capsule(joint, joint + reach, kTwigRadius, kBark));
  }
  return branch;
}

Object make_walker(const Eigen::Vector3d& foot, std::vector<TrackPoint> track) {
  Object walker = object(Kind::walker, foot, kWalkerRadius, kWalkerHeight);
  walker.bodies.push_back(
      capsule(up(kWalkerRadius), up(kWalkerHeight - kWalkerRadius), kWalkerRadius, kCloth));
  walker.track = std::move(track);
  return walker;
}

Object make_dust(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii_m, double hits_per_m) {
  Object dust = object(Kind::dust, centre, std::max(radii_m.x(), radii_m.y()), 2.0 * radii_m.z());
  dust.bodies.push_back(ellipsoid(centre, radii_m, kHaze));
  dust.bodies.back().hits_per_m = hits_per_m;
  return dust;
}

}  // namespace gvom::sim
