#include "tools/drive/cover.hpp"

#include <utility>

#include "tools/sim/materials.hpp"
#include "tools/sim/scenes/things.hpp"

namespace gvom::driving {
namespace {

constexpr double kBeside_m = 35;  // of the line, to both sides
constexpr double kSolidSpacing_m = 2.4;
constexpr double kSoftSpacing_m = 0.5;
constexpr double kGrassAnywhere_m = -100;  // from the line: on it too
constexpr double kWalking_mps = 1.3;
constexpr double kWalkersReach_m = 9;  // to both sides of the line
constexpr int kCrossings = 40;

sim::Strip strip_of(const CourseLeg& leg, double spacing_m) {
  return {-kBeside_m, kBeside_m, spacing_m, leg.from_m.x(), leg.to_m.x()};
}

int count_of(const CourseLeg& leg, double m2_per_thing) {
  if (m2_per_thing <= 0) return 0;
  return static_cast<int>(2 * kBeside_m * (leg.to_m.x() - leg.from_m.x()) / m2_per_thing);
}

}  // namespace

void plant(sim::Planter& planter, sim::Random& random, const CourseLeg& leg, const Cover& cover) {
  planter.trees(random, count_of(leg, cover.m2_per_tree), strip_of(leg, kSolidSpacing_m));
  planter.rocks(random, count_of(leg, cover.m2_per_rock), strip_of(leg, kSolidSpacing_m));
  planter.bushes(random, count_of(leg, cover.m2_per_bush), strip_of(leg, kSoftSpacing_m));
}

void sow_grass(sim::Planter& planter, sim::Random& random, const CourseLeg& leg) {
  for (const double part : {0.2, 0.4, 0.6, 0.8}) {
    const Eigen::Vector2d shift(random.between(-3, 3), random.between(-8, 8));
    planter.grass(random, leg.at(part) + shift, random.between(3, 5), kGrassAnywhere_m);
  }
}

void add_walker(sim::Planter& planter, sim::Random& random, const CourseLeg& leg) {
  const Eigen::Vector2d middle = leg.at(random.between(0.3, 0.7));
  const double first_s = random.between(0, 2 * kWalkersReach_m / kWalking_mps);
  std::vector<sim::TrackPoint> track;
  for (int crossing = 0; crossing <= kCrossings; ++crossing) {
    const double side = crossing % 2 == 0 ? -1 : 1;
    track.push_back({first_s + crossing * 2 * kWalkersReach_m / kWalking_mps, middle.x(),
                     middle.y() + side * kWalkersReach_m});
  }
  const Eigen::Vector3d foot = planter.on_ground(track.front().x_m, track.front().y_m);
  planter.add(sim::make_walker(foot, std::move(track)));
  for (double beside = -kWalkersReach_m; beside <= kWalkersReach_m; beside += 1)
    planter.keep_free(middle + Eigen::Vector2d(0, beside), 1);
}

void raise_dust(sim::WorldData& world, const sim::Planter& planter, sim::Random& random,
                const CourseLeg& leg) {
  for (const double part : {0.3, 0.6}) {
    const Eigen::Vector2d at = leg.at(part) + Eigen::Vector2d(random.between(-4, 4), random.between(-4, 4));
    const Eigen::Vector3d radii(random.between(2, 5), random.between(1.5, 4), random.between(0.8, 1.8));
    const Eigen::Vector3d foot = planter.on_ground(at.x(), at.y());
    world.objects.push_back(sim::make_dust(foot + Eigen::Vector3d(0, 0, 0.8 * radii.z()), radii,
                                           random.between(sim::kThinDust, sim::kDenseDust)));
  }
}

}  // namespace gvom::driving
