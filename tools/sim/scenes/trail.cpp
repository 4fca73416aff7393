#include "tools/sim/scenes/trail.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tools/sim/materials.hpp"
#include "tools/sim/noise.hpp"
#include "tools/sim/scenes/trail_ground.hpp"

namespace gvom::sim {
namespace {

constexpr double kPlanted = 52.0;    // around the driven trail: half of the paper's grid
constexpr double kMaxRange = 110.0;  // ground beyond, for rays that go on
constexpr double kPatch = 10.0;      // length of trail planted at a time
constexpr double kSpacing = 1.0;     // free ground between two things
constexpr double kPathStep = 0.5;

constexpr double kBranchX = 45.0;
constexpr double kBranchHeight = 2.7;
constexpr double kBranchRadius = 0.07;

constexpr double kPersonX = 38.0;
constexpr double kPersonSpeed = 1.4;
constexpr double kPersonRadius = 0.25;
constexpr double kPersonHeight = 1.8;
constexpr double kPersonAhead = 9.0;  // of the vehicle when in the middle of the trail
constexpr double kPersonWalk = 50.0;  // seconds before and after the crossing

constexpr double kSolid = std::numeric_limits<double>::infinity();

Body capsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m,
             std::uint8_t reflectivity) {
  return {Body::Shape::capsule, from, to - from, radius_m, 0.0, kSolid, reflectivity};
}

Body ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, double hits_per_m,
               std::uint8_t reflectivity) {
  return {Body::Shape::ellipsoid, centre, radii, 0.0, 0.0, hits_per_m, reflectivity};
}

class TrailBuilder {
 public:
  explicit TrailBuilder(const SceneParameters& parameters)
      : landscape_(parameters.seed),
        data_{"trail",
              trail_ground(landscape_, {-kMaxRange, -kMaxRange, parameters.length_m + kMaxRange, kMaxRange}),
              {},
              {},
              0.0},
        terrain_(data_.ground) {
    add_path(parameters.length_m);
    add_branch();
    // Each patch has its own stream, so that a longer drive goes through the same woods.
    const int first = static_cast<int>(std::floor(-kPlanted / kPatch));
    const int last = static_cast<int>(std::ceil((parameters.length_m + kPlanted) / kPatch));
    for (int patch = first; patch < last; ++patch)
      plant(patch * kPatch, derive(parameters.seed, static_cast<std::uint64_t>(patch + 1'000'000)));
    add_person((kPersonX - kPersonAhead) / parameters.speed_mps);
  }

  WorldData take() { return std::move(data_); }

 private:
  void add_path(double length_m);
  void plant(double from_x_m, std::uint64_t seed);
  void add_tree(Random& random, double x_m, double y_m);
  void add_bush(Random& random, double x_m, double y_m);
  void add_rock(Random& random, double x_m, double y_m);
  void add_branch();
  void add_person(double crossing_s);
  [[nodiscard]] bool is_free(double x_m, double y_m) const;
  [[nodiscard]] Eigen::Vector3d on_ground(double x_m, double y_m) const {
    return {x_m, y_m, terrain_.height_m(x_m, y_m)};
  }

  Landscape landscape_;
  WorldData data_;
  Terrain terrain_;
};

void TrailBuilder::add_path(double length_m) {
  double driven = 0.0;
  for (double x = 0.0; data_.path_m.empty() || driven < length_m; x += kPathStep) {
    const Eigen::Vector2d next(x, landscape_.trail_y_m(x));
    if (!data_.path_m.empty()) driven += (next - data_.path_m.back()).norm();
    data_.path_m.push_back(next);
  }
}

void TrailBuilder::plant(double from_x_m, std::uint64_t seed) {
  Random random(seed);
  const auto patch = [&](int count, double nearest_m, double farthest_m, auto add) {
    for (int i = 0; i < count; ++i) {
      const double x = from_x_m + random.between(0.0, kPatch);
      const double side = random.between(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
      const double y = landscape_.trail_y_m(x) + side * random.between(nearest_m, farthest_m);
      if (is_free(x, y)) (this->*add)(random, x, y);
    }
  };
  patch(4, 4.0, 14.0, &TrailBuilder::add_tree);
  patch(4, 10.0, 45.0, &TrailBuilder::add_tree);
  patch(3, 3.2, 9.0, &TrailBuilder::add_bush);
  patch(3, 6.0, 30.0, &TrailBuilder::add_bush);
  patch(3, 2.8, 12.0, &TrailBuilder::add_rock);
}

bool TrailBuilder::is_free(double x_m, double y_m) const {
  const TrailFrame ditch = landscape_.relative_to(kDitchX, x_m, y_m);
  if (std::abs(ditch.along_m) < 2.5 && std::abs(ditch.left_m) < 16.0) return false;
  const TrailFrame step = landscape_.relative_to(kStepX, x_m, y_m);
  if (std::abs(step.along_m) < 8.0 && step.left_m > 2.0 && step.left_m < 19.0) return false;
  const double lateral = std::abs(y_m - landscape_.trail_y_m(x_m));
  if (std::abs(x_m - kPersonX) < 2.0 && lateral < 10.0) return false;
  if (std::abs(x_m - kBranchX) < 2.5 && lateral < 6.0) return false;
  return std::none_of(data_.objects.begin(), data_.objects.end(), [&](const Object& other) {
    const double distance = std::hypot(other.position_m.x() - x_m, other.position_m.y() - y_m);
    return distance < other.radius_m + kSpacing;
  });
}

void TrailBuilder::add_tree(Random& random, double x_m, double y_m) {
  const Eigen::Vector3d foot = on_ground(x_m, y_m);
  const double radius = random.between(0.15, 0.30);
  const double height = random.between(4.0, 8.0);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const double crown_bottom = std::max(2.6, 0.45 * height);
  const double half = 0.5 * (height - crown_bottom);
  const double spread = random.between(0.9, 1.6);
  data_.objects.push_back(
      {Kind::tree,
       foot,
       radius,
       height,
       {capsule(foot - 0.5 * up, foot + 0.8 * height * up, radius, kBark),
        ellipsoid(foot + (crown_bottom + half) * up, {spread, spread, half}, kCrown, kLeaves)},
       {}});
}

void TrailBuilder::add_bush(Random& random, double x_m, double y_m) {
  const double rx = random.between(0.5, 1.2), ry = random.between(0.5, 1.2), rz = random.between(0.5, 1.0);
  const Eigen::Vector3d foot = on_ground(x_m, y_m);
  const double density = random.between(kThinBush, kDenseBush);
  data_.objects.push_back(
      {Kind::bush,
       foot,
       std::max(rx, ry),
       1.6 * rz,
       {ellipsoid(foot + Eigen::Vector3d(0.0, 0.0, 0.6 * rz), {rx, ry, rz}, density, kLeaves)},
       {}});
}

void TrailBuilder::add_rock(Random& random, double x_m, double y_m) {
  const double radius = random.between(0.3, 0.6);
  const bool tall = random.between(0.0, 1.0) < 0.4;
  const double height = tall ? random.between(0.9, 1.4) : radius;
  const Eigen::Vector3d foot = on_ground(x_m, y_m);
  data_.objects.push_back(
      {Kind::rock, foot, radius, height, {ellipsoid(foot, {radius, radius, height}, kSolid, kStone)}, {}});
}

/// The tree beside the trail that the branch grows from, and the branch.
void TrailBuilder::add_branch() {
  const double middle = landscape_.trail_y_m(kBranchX);
  const double ground = terrain_.height_m(kBranchX, middle);
  const Eigen::Vector3d foot = on_ground(kBranchX, middle + 3.4);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  data_.objects.push_back(
      {Kind::tree, foot, 0.22, 6.0, {capsule(foot - 0.5 * up, foot + 6.0 * up, 0.22, kBark)}, {}});

  const Eigen::Vector3d root(kBranchX, middle + 3.4, ground + kBranchHeight + 0.3);
  const Eigen::Vector3d tip(kBranchX + 0.6, middle - 3.2, ground + kBranchHeight + kBranchRadius);
  Object branch{Kind::branch, on_ground(kBranchX, middle), kBranchRadius, kBranchHeight, {}, {}};
  branch.bodies.push_back(capsule(root, tip, kBranchRadius, kBark));
  for (int twig = 1; twig <= 8; ++twig) {
    const Eigen::Vector3d joint = root + twig / 9.0 * (tip - root);
    const Eigen::Vector3d reach(twig % 2 == 0 ? 0.7 : -0.7, -0.3, 0.25);
    branch.bodies.push_back(capsule(joint, joint + reach, 0.02, kBark));
  }
  data_.objects.push_back(branch);
}

void TrailBuilder::add_person(double crossing_s) {
  const double middle = landscape_.trail_y_m(kPersonX);
  const double reach = kPersonSpeed * kPersonWalk;
  const Eigen::Vector3d low(0, 0, kPersonRadius), high(0, 0, kPersonHeight - kPersonRadius);
  data_.objects.push_back({Kind::walker,
                           on_ground(kPersonX, middle),
                           kPersonRadius,
                           kPersonHeight,
                           {capsule(low, high, kPersonRadius, kCloth)},
                           {{crossing_s - kPersonWalk, kPersonX, middle - reach},
                            {crossing_s + kPersonWalk, kPersonX, middle + reach}}});
}

}  // namespace

WorldData make_trail(const SceneParameters& parameters) {
  return TrailBuilder(parameters).take();
}

}  // namespace gvom::sim
