// The truth of hand-made worlds, column by column, and of the trail.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/tools/sim_worlds.hpp"
#include "tools/sim/ground_truth.hpp"
#include "tools/sim/scenes/trail.hpp"
#include "tools/sim/scenes/trail_landscape.hpp"
#include "tools/sim/trajectory.hpp"

using namespace gvom::sim;
using namespace gvom::test;

namespace {

/// One column of the truth.
struct Place {
  ObjectClass what;
  int object;
  bool drivable, lethal, vegetation;
  float lowest_m, mean_m, drop_m, clearance_m;
};

class Truth {
 public:
  explicit Truth(WorldData data, double seconds = 0.0)
      : world_(std::move(data)), truth_(sample_truth(world_, {0.4, seconds, 2})) {}

  [[nodiscard]] Place at(double x_m, double y_m) const {
    const auto index = [&](double value, int axis) {
      return static_cast<std::int64_t>(std::floor(value / 0.4)) - truth_.origin[axis];
    };
    const auto i = static_cast<std::size_t>(index(y_m, 1) * truth_.size_x + index(x_m, 0));
    return {static_cast<ObjectClass>(truth_.classes[i]),
            truth_.object[i],
            truth_.drivable[i] != 0,
            truth_.lethal[i] != 0,
            truth_.vegetation[i] != 0,
            truth_.ground_lowest[i],
            truth_.ground_mean[i],
            truth_.drop_m[i],
            truth_.clearance[i]};
  }

  [[nodiscard]] const World& world() const { return world_; }

 private:
  World world_;
  GroundTruth truth_;
};

constexpr float kFree = std::numeric_limits<float>::infinity();

}  // namespace

TEST_CASE("plain ground is drivable and nothing else") {
  const Truth truth(level_world());
  const Place place = truth.at(10.2, 0.2);
  CHECK(place.what == ObjectClass::ground);
  CHECK(place.object == -1);
  CHECK(place.drivable);
  CHECK_FALSE(place.lethal);
  CHECK_FALSE(place.vegetation);
  CHECK(place.lowest_m == 0.0F);
  CHECK(place.clearance_m == kFree);
}

TEST_CASE("a hole drops by as much as its rim is higher, a deep one is lethal") {
  WorldData data = level_world();
  paint(data, {10.0, -5.0}, {12.0, 5.0}, Surface::hole, -0.8);
  paint(data, {20.0, -5.0}, {22.0, 5.0}, Surface::hole, -0.3);
  const Truth truth(std::move(data));
  const Place deep = truth.at(11.0, 0.2);
  CHECK(deep.what == ObjectClass::ditch);
  CHECK(deep.drop_m == Approx(0.8F));
  CHECK(deep.lowest_m == Approx(-0.8F));
  CHECK(deep.lethal);
  CHECK_FALSE(deep.drivable);
  const Place shallow = truth.at(21.0, 0.2);
  CHECK(shallow.drop_m == Approx(0.3F));
  CHECK_FALSE(shallow.lethal);
  CHECK_FALSE(shallow.drivable);
  CHECK_FALSE(truth.at(9.4, 0.2).drivable);  // beside it
  CHECK(truth.at(9.0, 0.2).drivable);
  CHECK(truth.at(9.0, 0.2).drop_m == 0.0F);
}

TEST_CASE("a face is lethal where it rises by half a metre, steep ground is not drivable") {
  WorldData data = level_world();
  paint(data, {10.0, -5.0}, {10.0, 5.0}, Surface::face, 0.0);
  paint(data, {10.1, -5.0}, {90.0, 5.0}, Surface::ground, 0.6);
  paint(data, {30.0, -5.0}, {30.0, 5.0}, Surface::face, 0.6);
  paint(data, {30.1, -5.0}, {90.0, 5.0}, Surface::ground, 0.75);
  for (int iy = 0; iy < 601; ++iy)  // a slope of 30 degrees along y, far aside
    for (int ix = 0; ix < 1201; ++ix)
      if (iy > 500) data.ground.height_m[iy * 1201 + ix] = 0.1F * static_cast<float>(iy - 500) * 0.57735F;
  const Truth truth(std::move(data));
  CHECK(truth.at(10.05, 0.2).what == ObjectClass::step_face);
  CHECK(truth.at(10.05, 0.2).lethal);
  CHECK_FALSE(truth.at(10.05, 0.2).drivable);
  CHECK(truth.at(30.05, 0.2).what == ObjectClass::step_face);
  CHECK_FALSE(truth.at(30.05, 0.2).lethal);
  CHECK(truth.at(20.2, 0.2).drivable);
  CHECK_FALSE(truth.at(20.2, 25.0).drivable);
  CHECK(truth.at(20.2, 25.0).what == ObjectClass::ground);
  CHECK_FALSE(truth.at(20.2, 25.0).lethal);
}

TEST_CASE("what stands in a column gives its class, and bars it if it is in a vehicle's way") {
  WorldData data = level_world();
  add(data, Kind::tree, post(5.0, 0.0, 0.2, 6.0), 6.0);                      // 0
  add(data, Kind::bush, box({10.0, 0.0, 0.5}, {0.5, 0.5, 0.5}), 1.0, 0.1);   // 1
  add(data, Kind::grass, box({15.0, 0.0, 0.3}, {1.0, 1.0, 0.3}), 0.6, 0.5);  // 2
  add(data, Kind::rock, ball({20.0, 0.0, 0.0}, 0.6), 0.6);                   // 3
  add(data, Kind::rock, ball({25.0, 0.0, 0.0}, 0.2), 0.2);                   // 4
  add(data, Kind::wall, box({30.0, 0.0, 1.0}, {0.1, 2.0, 1.0}), 2.0);        // 5
  add(data, Kind::car, box({35.0, 0.0, 0.7}, {2.0, 0.8, 0.5}), 1.2);         // 6
  add(data, Kind::branch, box({40.0, 0.0, 1.3}, {0.1, 2.0, 0.1}), 1.2);      // 7
  add(data, Kind::branch, box({45.0, 0.0, 2.6}, {0.1, 2.0, 0.1}), 2.5);      // 8
  add(data, Kind::tree, ball({50.0, 0.0, 2.3}, 1.0), 3.3, 0.35);             // 9: hangs to 1.3 m
  add(data, Kind::tree, ball({55.0, 0.0, 4.0}, 1.0), 5.0, 0.35);             // 10: to 3 m
  add(data, Kind::dust, box({8.0, 5.0, 1.0}, {1.0, 1.0, 1.0}), 2.0, 0.1);    // 11
  paint(data, {13.0, 4.0}, {15.0, 6.0}, Surface::mirror, 0.0);
  paint(data, {18.0, 4.0}, {20.0, 6.0}, Surface::dark, 0.0);
  const Truth truth(std::move(data));
  const auto check = [&](double x, double y, ObjectClass what, int object, const char* marks) {
    INFO(x);
    const Place place = truth.at(x, y);
    CHECK(place.what == what);
    CHECK(place.object == object);
    std::string found;
    if (place.drivable) found += 'd';
    if (place.lethal) found += 'l';
    if (place.vegetation) found += 'v';
    CHECK(found == marks);
  };
  check(5.0, 0.0, ObjectClass::tree, 0, "l");
  check(10.0, 0.0, ObjectClass::bush, 1, "v");
  check(15.0, 0.0, ObjectClass::grass, 2, "dv");
  check(20.0, 0.0, ObjectClass::rock, 3, "l");
  check(25.0, 0.0, ObjectClass::rock, 4, "");
  check(30.0, 0.0, ObjectClass::wall, 5, "l");
  check(35.0, 0.0, ObjectClass::car, 6, "l");
  check(40.0, 0.0, ObjectClass::overhang, 7, "l");
  check(45.0, 0.0, ObjectClass::overhang, 8, "d");
  check(50.0, 0.0, ObjectClass::tree, 9, "v");
  check(55.0, 0.0, ObjectClass::overhang, 10, "dv");
  check(8.0, 5.0, ObjectClass::ground, -1, "d");
  check(14.0, 5.0, ObjectClass::mirror, -1, "d");
  check(19.0, 5.0, ObjectClass::dark, -1, "d");
  CHECK(truth.at(40.0, 0.0).clearance_m == Approx(1.2F));
  CHECK(truth.at(45.0, 0.0).clearance_m == Approx(2.5F));
  CHECK(truth.at(55.0, 0.0).clearance_m == Approx(3.0F).margin(0.1));
  CHECK(truth.at(35.0, 0.0).clearance_m == kFree);
}

TEST_CASE("columns through which a walker comes are a person's, and stay drivable") {
  WorldData data = level_world();
  Object walker;
  walker.kind = Kind::walker;
  walker.bodies = {post(0.0, 0.0, 0.25, 1.8)};
  walker.track = {{0.0, 10.2, -5.0}, {10.0, 10.2, 5.0}};
  data.objects.push_back(walker);
  const Truth truth(std::move(data), 5.0);
  CHECK(truth.at(10.2, -3.0).what == ObjectClass::person);
  CHECK(truth.at(10.2, -3.0).object == 0);
  CHECK(truth.at(10.2, -3.0).drivable);
  CHECK(truth.at(10.2, 3.0).what == ObjectClass::ground);  // comes later
}

TEST_CASE("the trail's truth has the ditch 1.2 m deep and 2 m wide, and the vehicle bridges it") {
  const Truth truth(make_trail({7, 40.0, 5.0}));
  const Landscape landscape(7);
  const double middle = landscape.trail_y_m(kDitchX);
  const Place bottom = truth.at(kDitchX, middle);
  CHECK(bottom.what == ObjectClass::ditch);
  CHECK(bottom.lethal);
  CHECK(bottom.drop_m == Approx(1.2F).margin(0.2));
  CHECK(bottom.lowest_m == Approx(landscape.relief_m(kDitchX, middle) - 1.2).margin(0.1));
  CHECK(truth.at(kDitchX - 2.0, middle).what == ObjectClass::ground);
  CHECK(truth.at(kDitchX + 2.0, middle).what == ObjectClass::ground);
  CHECK(truth.at(kDitchX - 4.0, landscape.trail_y_m(kDitchX - 4.0)).drivable);

  const Trajectory trajectory(truth.world().terrain(), truth.world().data().path_m, {5.0, 0.0});
  for (double time = 0.0; time < 8.0; time += 0.01) {
    const double rise = trajectory.at(time + 0.01).translation_m.z() - trajectory.at(time).translation_m.z();
    CHECK(std::abs(rise) < 0.02);
  }
}

TEST_CASE("trees and rocks stand in the trail's truth where they stand in the world") {
  const Truth truth(make_trail({7, 20.0, 5.0}));
  int judged = 0;
  for (const Object& object : truth.world().data().objects) {
    if (object.kind == Kind::branch || object.kind == Kind::walker) continue;
    if (std::abs(object.position_m.y()) > 45.0 || object.position_m.x() < -45.0 ||
        object.position_m.x() > 60.0)
      continue;
    const auto expected = object.kind == Kind::tree   ? ObjectClass::tree
                          : object.kind == Kind::bush ? ObjectClass::bush
                                                      : ObjectClass::rock;
    CHECK(truth.at(object.position_m.x(), object.position_m.y()).what == expected);
    ++judged;
  }
  CHECK(judged > 100);
}
