// The simulated world is what it says: rays meet the ground, solids stop every ray, bushes some.
#include <cmath>

#include <catch2/catch.hpp>

#include "tools/sim/ground_truth.hpp"
#include "tools/sim/noise.hpp"

using namespace gvom::sim;

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

const World& world() {
  static const World the_world({7, 20.0, 5.0});
  return the_world;
}

GroundTruth short_truth(double resolution_m) {
  RecordingOptions options;
  options.seconds = 1.0;
  options.threads = 2;
  const Trajectory trajectory(world().landscape(), 5.0, 20.0, 0.0);
  return sample_truth({world(), trajectory, options}, resolution_m);
}

Ray ray_towards(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return {from, (to - from).normalized()};
}

/// The first centimetre along the ray that is below the ground.
double march(const Ray& ray, double max_range_m) {
  for (double distance = 0.0; distance < max_range_m; distance += 0.01) {
    const Eigen::Vector3d point = ray.origin + distance * ray.direction;
    if (point.z() < world().terrain().height_m(point.x(), point.y())) return distance;
  }
  return kNever;
}

}  // namespace

TEST_CASE("a ray meets the ground where a slow march along it does") {
  Random random(3);
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    const double x = random.between(-10.0, 40.0), y = random.between(-15.0, 15.0);
    const Eigen::Vector3d from(x, y, world().terrain().height_m(x, y) + random.between(0.5, 2.0));
    const double heading = random.between(0.0, 6.28);
    const Ray ray = ray_towards(
        from, from + Eigen::Vector3d(std::cos(heading), std::sin(heading), random.between(-0.4, 0.1)));
    const double fast = world().terrain().intersect(ray, 60.0);
    const double slow = march(ray, 60.0);
    if (slow == kNever) continue;  // a graze between two steps may be a hit all the same
    ++hits;
    CHECK(fast <= slow + 1e-9);
    const Eigen::Vector3d point = ray.origin + fast * ray.direction;
    CHECK(std::abs(point.z() - world().terrain().height_m(point.x(), point.y())) < 1e-6);
    if (fast < slow - 0.011) CHECK(march({ray.origin, ray.direction}, fast - 0.02) == kNever);
  }
  CHECK(hits > 200);
}

TEST_CASE("a ray straight down measures the height, one straight up nothing") {
  const Eigen::Vector3d above(5.0, -1.0, 10.0);
  const double ground = world().terrain().height_m(5.0, -1.0);
  CHECK(world().terrain().intersect({above, -Eigen::Vector3d::UnitZ()}, 100.0) == Approx(10.0 - ground));
  CHECK(world().terrain().intersect({above, Eigen::Vector3d::UnitZ()}, 100.0) == kNever);
  CHECK(world().terrain().intersect({above, -Eigen::Vector3d::UnitZ()}, 5.0) == kNever);
}

TEST_CASE("a sphere and a capsule are entered and left where geometry says") {
  Primitive sphere;
  sphere.centre = {10.0, 0.0, 0.0};
  sphere.size = {2.0, 2.0, 2.0};
  const Interval through = intersect(sphere, {{0, 0, 0}, {1, 0, 0}});
  CHECK(through.enter == Approx(8.0));
  CHECK(through.leave == Approx(12.0));
  CHECK(intersect(sphere, {{0, 2.001, 0}, {1, 0, 0}}).empty());

  Primitive capsule;
  capsule.shape = Primitive::Shape::capsule;
  capsule.centre = {5.0, 0.0, 0.0};
  capsule.size = {0.0, 0.0, 3.0};
  capsule.radius_m = 0.5;
  CHECK(intersect(capsule, {{0, 0, 1}, {1, 0, 0}}).enter == Approx(4.5));
  const Interval lengthwise = intersect(capsule, {{5, 0, -10}, {0, 0, 1}});
  CHECK(lengthwise.enter == Approx(9.5));
  CHECK(lengthwise.leave == Approx(13.5));
  CHECK(intersect(capsule, {{0, 0, 3.51}, {1, 0, 0}}).empty());
}

TEST_CASE("trunks and rocks stop every ray, bushes stop some and let some through") {
  const Primitive nobody = world().person_at(-1000.0);
  int soft = 0, stopped = 0, passed = 0;
  for (const Primitive& body : world().primitives()) {
    if (world().objects()[body.object].kind != "bush") continue;
    ++soft;
    const Eigen::Vector3d from = body.centre + Eigen::Vector3d(0.0, 0.0, 3.0);
    for (std::uint64_t key = 0; key < 200; ++key) {
      const double range = world().cast(ray_towards(from, body.centre), nobody, 100.0, key).range_m;
      const double top = 3.0 - body.size.z();
      CHECK(range >= top - 1e-9);
      ++(range < 3.0 + 0.59 * body.size.z() ? stopped : passed);
    }
  }
  CHECK(soft > 20);
  CHECK(stopped > 100 * soft);
  CHECK(passed > 20 * soft);

  for (const Object& object : world().objects()) {
    if (object.kind != "rock") continue;
    const Eigen::Vector3d above = object.position_m + Eigen::Vector3d(0.0, 0.0, 2.5);
    for (std::uint64_t key = 0; key < 5; ++key)
      CHECK(world().cast({above, -Eigen::Vector3d::UnitZ()}, nobody, 100.0, key).range_m <=
            Approx(2.5 - object.height_m));
  }
}

TEST_CASE("the person walks across the trail at 1.4 m/s") {
  const Eigen::Vector3d before = world().person_at(2.0).centre;
  const Eigen::Vector3d after = world().person_at(3.0).centre;
  CHECK((after - before).head<2>().norm() == Approx(1.4));
  const double crossing = (38.0 - 9.0) / 5.0;
  CHECK(world().person_at(crossing).centre.y() == Approx(world().landscape().trail_y_m(38.0)));
}

TEST_CASE("the truth has the ditch 1.2 m deep and 2 m wide across the trail") {
  const GroundTruth truth = short_truth(0.4);
  const auto column = [&](double x, double y) {
    const auto index = [&](double value, int axis) {
      return static_cast<std::int64_t>(std::floor(value / 0.4)) - truth.origin[axis];
    };
    return static_cast<std::size_t>(index(y, 1) * truth.size_x + index(x, 0));
  };
  const double middle = world().landscape().trail_y_m(kDitchX);
  const std::size_t bottom = column(kDitchX, middle);
  CHECK(truth.classes[bottom] == static_cast<std::uint8_t>(ObjectClass::ditch));
  CHECK(truth.ditch_depth[bottom] == Approx(1.2F));
  const double rim = world().landscape().relief_m(kDitchX, middle);
  CHECK(truth.ground_lowest[bottom] == Approx(rim - 1.2).margin(0.1));
  CHECK(truth.classes[column(kDitchX - 2.0, middle)] == static_cast<std::uint8_t>(ObjectClass::ground));
  CHECK(truth.classes[column(kDitchX + 2.0, middle)] == static_cast<std::uint8_t>(ObjectClass::ground));

  // The vehicle bridges it: its height follows the rims.
  const Trajectory trajectory(world().landscape(), 5.0, 40.0, 0.0);
  for (double time = 5.0; time < 7.0; time += 0.01)
    CHECK(std::abs(trajectory.at(time + 0.01).translation_m.z() - trajectory.at(time).translation_m.z()) <
          0.02);
}

TEST_CASE("trees and rocks stand in the truth where they stand in the world") {
  const GroundTruth truth = short_truth(0.4);
  int judged = 0;
  for (const Object& object : world().objects()) {
    if (object.kind == "branch") continue;
    const std::int64_t x =
        static_cast<std::int64_t>(std::floor(object.position_m.x() / 0.4)) - truth.origin[0];
    const std::int64_t y =
        static_cast<std::int64_t>(std::floor(object.position_m.y() / 0.4)) - truth.origin[1];
    if (x < 0 || y < 0 || x >= truth.size_x || y >= truth.size_y) continue;
    const auto expected = object.kind == "tree"   ? ObjectClass::tree
                          : object.kind == "bush" ? ObjectClass::bush
                                                  : ObjectClass::rock;
    CHECK(truth.classes[y * truth.size_x + x] == static_cast<std::uint8_t>(expected));
    ++judged;
  }
  CHECK(judged > 100);
}
