// The simulated world is what it says: rays meet the ground and what stands on it where geometry says.
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/tools/sim_worlds.hpp"
#include "tools/sim/materials.hpp"
#include "tools/sim/noise.hpp"
#include "tools/sim/scenes/trail.hpp"

using namespace gvom::sim;
using namespace gvom::test;

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

const World& trail() {
  static const World the_world(make_trail({7, 20.0, 5.0}));
  return the_world;
}

Ray ray_towards(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return {from, (to - from).normalized()};
}

double range(const World& world, const Ray& ray, std::uint64_t key = 1) {
  return world.cast(ray, {}, 100.0, key).range_m;
}

/// The first centimetre along the ray that is below the ground.
double march(const Ray& ray, double max_range_m) {
  for (double distance = 0.0; distance < max_range_m; distance += 0.01) {
    const Eigen::Vector3d point = ray.origin + distance * ray.direction;
    if (point.z() < trail().terrain().height_m(point.x(), point.y())) return distance;
  }
  return kNever;
}

/// The share of 20,000 keys with which the ray ends before `limit_m`.
double share_before(const World& world, const Ray& ray, double limit_m) {
  int before = 0;
  for (std::uint64_t key = 0; key < 20'000; ++key) before += range(world, ray, mix(key)) < limit_m;
  return before / 20'000.0;
}

}  // namespace

TEST_CASE("a ray meets the ground where a slow march along it does") {
  Random random(3);
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    const double x = random.between(-10.0, 40.0), y = random.between(-15.0, 15.0);
    const Eigen::Vector3d from(x, y, trail().terrain().height_m(x, y) + random.between(0.5, 2.0));
    const double heading = random.between(0.0, 6.28);
    const Ray ray = ray_towards(
        from, from + Eigen::Vector3d(std::cos(heading), std::sin(heading), random.between(-0.4, 0.1)));
    const double fast = trail().terrain().intersect(ray, 60.0);
    const double slow = march(ray, 60.0);
    if (slow == kNever) continue;  // a graze between two steps may be a hit all the same
    ++hits;
    CHECK(fast <= slow + 1e-9);
    const Eigen::Vector3d point = ray.origin + fast * ray.direction;
    CHECK(std::abs(point.z() - trail().terrain().height_m(point.x(), point.y())) < 1e-6);
    if (fast < slow - 0.011) CHECK(march({ray.origin, ray.direction}, fast - 0.02) == kNever);
  }
  CHECK(hits > 200);
}

TEST_CASE("a ray straight down measures the height, one straight up nothing; grounds of any size") {
  WorldData data;
  data.ground = {0.5, -1.0, -1.0, 4, 3, {0, 0, 0, 0, 0, 2, 2, 0, 0, 0, 0, 0}, {}};
  data.path_m = {{-1.0, -1.0}, {0.0, -1.0}};
  const World world(std::move(data));
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  CHECK(range(world, {{-0.5, -0.5, 10.0}, down}) == Approx(8.0));
  CHECK(range(world, {{-0.75, -0.5, 10.0}, down}) == Approx(9.0));   // half-way up
  CHECK(range(world, {{-0.75, -0.75, 10.0}, down}) == Approx(9.5));  // bilinear
  CHECK(range(world, {{-0.75, -0.5, 10.0}, -down}) == kNever);
  CHECK(range(world, {{5.0, -0.5, 10.0}, down}) == kNever);  // beyond the area
  CHECK(world.terrain().height_m(5.0, -1.0) == 0.0);
  CHECK(world.terrain().height_m(-0.25, -0.5) == 2.0);
  CHECK(world.terrain().intersect({{-0.5, -0.5, 10.0}, down}, 5.0) == kNever);
  CHECK(range(world, ray_towards({-0.9, -0.5, 1.0}, {0.4, -0.5, 1.0})) == Approx(0.15));
}

TEST_CASE("a sphere, a capsule and a turned box are entered and left where geometry says") {
  const Primitive sphere(ball({10.0, 0.0, 0.0}, 2.0), 0);
  const Interval through = intersect(sphere, {{0, 0, 0}, {1, 0, 0}});
  CHECK(through.enter == Approx(8.0));
  CHECK(through.leave == Approx(12.0));
  CHECK(intersect(sphere, {{0, 2.001, 0}, {1, 0, 0}}).empty());
  CHECK(cos_incidence(sphere, {10.0 - std::sqrt(3.0), 1.0, 0.0}, {1, 0, 0}) == Approx(std::sqrt(3.0) / 2.0));

  Body tube;
  tube.shape = Body::Shape::capsule;
  tube.centre = {5.0, 0.0, 0.0};
  tube.size = {0.0, 0.0, 3.0};
  tube.radius_m = 0.5;
  const Primitive capsule(tube, 0);
  CHECK(intersect(capsule, {{0, 0, 1}, {1, 0, 0}}).enter == Approx(4.5));
  const Interval lengthwise = intersect(capsule, {{5, 0, -10}, {0, 0, 1}});
  CHECK(lengthwise.enter == Approx(9.5));
  CHECK(lengthwise.leave == Approx(13.5));
  CHECK(intersect(capsule, {{0, 0, 3.51}, {1, 0, 0}}).empty());

  // 4 x 2 x 2 m, turned by 30 degrees: the ray enters by the long face, whose normal is at -60 degrees.
  const double yaw = 3.14159265358979 / 6.0;
  const Primitive turned(box({10.0, 0.0, 0.0}, {2.0, 1.0, 1.0}, yaw), 0);
  const Interval slab = intersect(turned, {{10.0, -5.0, 0.5}, {0, 1, 0}});
  CHECK(slab.enter == Approx(5.0 - 1.0 / std::cos(yaw)));
  CHECK(slab.leave == Approx(5.0 + 1.0 / std::cos(yaw)));
  CHECK(cos_incidence(turned, {10.0, -1.0 / std::cos(yaw), 0.5}, {0, 1, 0}) == Approx(std::cos(yaw)));
  CHECK(intersect(turned, {{10.0, -5.0, 1.001}, {0, 1, 0}}).empty());
  CHECK(turned.upper.x() == Approx(10.0 + 2.0 * std::cos(yaw) + 1.0 * std::sin(yaw)));
  CHECK(turned.upper.y() == Approx(2.0 * std::sin(yaw) + 1.0 * std::cos(yaw)));
}

TEST_CASE("the box around a body holds every point of it, and no less than that is needed") {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    Body body = box({1.0, 2.0, 3.0}, {random.between(0.1, 2), random.between(0.1, 2), random.between(0.1, 2)},
                    random.between(-3.0, 3.0));
    if (i % 2 == 0) body.shape = Body::Shape::ellipsoid;
    const Primitive whole(body, 0);
    const Eigen::Vector3d above(0.0, 0.0, 10.0);
    const double x = random.between(-3.0, 5.0), y = random.between(-2.0, 6.0);
    const bool hit = !intersect(whole, {{x, y, 10.0}, -Eigen::Vector3d::UnitZ()}).empty();
    const bool within =
        x > whole.lower.x() && x < whole.upper.x() && y > whole.lower.y() && y < whole.upper.y();
    CHECK((within || !hit));
    // A plane that touches the box's side touches the body.
    const double inside = whole.upper.x() - 1e-3;
    bool met = false;
    for (double side = whole.lower.y(); side < whole.upper.y() && !met; side += 1e-3)
      met = !intersect(whole, {{inside, side, 10.0}, -Eigen::Vector3d::UnitZ()}).empty();
    CHECK(met);
  }
}

TEST_CASE("solids stop every ray, leaves as many as their rate says") {
  WorldData data = level_world();
  add(data, Kind::bush, box({10.0, 0.0, 1.0}, {1.0, 5.0, 1.0}), 2.0, kDenseBush);
  add(data, Kind::rock, ball({20.0, 0.0, 0.5}, 0.5));
  const World world(std::move(data));
  const Ray along{{0.0, 0.0, 0.5}, {1.0, 0.0, 0.0}};
  CHECK(share_before(world, along, 11.0) == Approx(1.0 - std::exp(-2.0 * kDenseBush)).margin(0.01));
  CHECK(share_before(world, along, 10.0) == Approx(1.0 - std::exp(-1.0 * kDenseBush)).margin(0.01));
  CHECK(share_before(world, along, 9.0) == 0.0);
  CHECK(share_before(world, along, 19.5 + 1e-9) == 1.0);
  // From within, the way counts from there.
  CHECK(share_before(world, {{10.0, 0.0, 0.5}, {1.0, 0.0, 0.0}}, 1.0) ==
        Approx(1.0 - std::exp(-kDenseBush)).margin(0.01));
}

TEST_CASE("of rays to 30 m the rain stops as many as its rate says") {
  WorldData data = level_world();
  data.rain_hits_per_m = kRain;
  const World world(std::move(data));
  CHECK(share_before(world, {{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}}, 30.0) == Approx(0.0036).margin(0.0012));
}

TEST_CASE("water mirrors: what is seen in it lies below it, as far as the whole way") {
  WorldData data = level_world();
  paint(data, {9.0, -1.0}, {11.0, 1.0}, Surface::mirror, 0.0);
  paint(data, {4.0, -1.0}, {6.0, 1.0}, Surface::dark, 0.0);
  add(data, Kind::wall, box({20.5, 0.0, 2.0}, {0.5, 5.0, 2.0}));
  const World world(std::move(data));
  // Down by 1 m in 10, met at x = 10; the mirrored ray meets the wall at (20, 0, 1).
  const Hit hit = world.cast(ray_towards({0.0, 0.0, 1.0}, {10.0, 0.0, 0.0}), {}, 100.0, 1);
  CHECK(hit.range_m == Approx(std::hypot(20.0, 2.0)).margin(2e-3));
  CHECK(hit.reflectivity == 60);
  CHECK(hit.cos_incidence == Approx(10.0 / std::hypot(10.0, 1.0)));
  // Steeper, over the wall: nothing comes back.
  CHECK(range(world, ray_towards({5.0, 0.0, 5.0}, {10.0, 0.0, 0.0})) == kNever);
  CHECK(range(world, ray_towards({0.0, 0.0, 1.0}, {5.0, 0.0, 0.0})) == kNever);  // dark
  CHECK(range(world, ray_towards({0.0, 0.0, 1.0}, {8.0, 0.0, 0.0})) == Approx(std::hypot(8.0, 1.0)));
  CHECK(world.cast(ray_towards({0.0, 0.0, 1.0}, {10.0, 0.0, 0.0}), {}, 15.0, 1).range_m == kNever);
}

TEST_CASE("walkers are where their tracks say, several of them, and stop rays there") {
  WorldData data = level_world();
  for (const double y : {5.0, -5.0}) {
    Object walker;
    walker.kind = Kind::walker;
    walker.bodies = {post(0.0, 0.0, 0.25, 1.8)};
    walker.track = {{2.0, 10.0, y}, {4.0, 12.0, y}, {5.0, 12.0, 0.0}};
    data.objects.push_back(walker);
  }
  const World world(std::move(data));
  CHECK(world.primitives().empty());
  CHECK(world.walkers_at(0.0)[0].body.centre.x() == 10.0);
  CHECK(world.walkers_at(3.0)[1].body.centre.x() == Approx(11.0));
  CHECK(world.walkers_at(4.5)[1].body.centre.y() == Approx(-2.5));
  CHECK(world.walkers_at(9.0)[0].body.centre.y() == 0.0);
  const Ray along{{0.0, -5.0, 1.0}, {1.0, 0.0, 0.0}};
  CHECK(world.cast(along, world.walkers_at(3.0), 100.0, 1).range_m == Approx(10.75));
  CHECK(world.cast(along, {}, 100.0, 1).range_m == kNever);
}

TEST_CASE("the trail's person walks across at 1.4 m/s, 9 m ahead of the vehicle") {
  const double crossing = (38.0 - 9.0) / 5.0;
  const Eigen::Vector3d before = trail().walkers_at(2.0).front().body.centre;
  const Eigen::Vector3d after = trail().walkers_at(3.0).front().body.centre;
  CHECK((after - before).head<2>().norm() == Approx(1.4));
  const auto& objects = trail().data().objects;
  const auto person = std::find_if(objects.begin(), objects.end(),
                                   [](const Object& object) { return object.kind == Kind::walker; });
  CHECK(trail().walkers_at(crossing).front().body.centre.y() == Approx(person->position_m.y()));
}
