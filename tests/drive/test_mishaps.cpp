// Drives end where geometry says, and only there.
#include <cmath>
#include <utility>

#include <catch2/catch.hpp>

#include "tests/drive/driven.hpp"

using namespace gvom;
using namespace gvom::driving;
using namespace gvom::test;

namespace {

constexpr double kSpeed_mps = 2;
constexpr double kStep_m = kSpeed_mps * kStep_s;

Driven drive_in(sim::WorldData data, double seconds = 12) {
  const sim::World world(std::move(data));
  return drive_on(world, {0, 0, 0}, kSpeed_mps, seconds);
}

sim::WorldData with(sim::Kind kind, const sim::Body& body, double hits_per_m = HUGE_VAL) {
  sim::WorldData data = level_world();
  add(data, kind, body, 1.0, hits_per_m);
  return data;
}

/// What happened, and where base_link was.
void check(const Driven& driven, Accident what, double x_m, double margin_m) {
  REQUIRE(driven.mishap);
  CHECK(driven.mishap->what == what);
  CHECK(driven.place.x_m == Approx(x_m).margin(margin_m));
}

}  // namespace

TEST_CASE("it hits a trunk with its bumper, and passes beside it") {
  const Driven driven = drive_in(with(sim::Kind::tree, post(10, 0.3, 0.15, 4)));
  check(driven, Accident::hit, 10 - 0.15 - 0.8, kStep_m + 0.01);
  CHECK(driven.mishap->object == 0);
  CHECK(driven.mishap->against == sim::ObjectClass::tree);
  CHECK(driven.mishap->speed_mps == Approx(kSpeed_mps));
  CHECK(drive_in(with(sim::Kind::tree, post(10, 0.7 + 0.1, 0.15, 4))).mishap);
  CHECK_FALSE(drive_in(with(sim::Kind::tree, post(10, 0.7 + 0.17, 0.15, 4))).mishap);
}

TEST_CASE("rocks lower than the clearance and branches higher than the roof are passed") {
  const double radius_m = 0.5;
  const auto rock = [&](double top_m) {
    return with(sim::Kind::rock, ball({10, 0, top_m - radius_m}, radius_m));
  };
  CHECK_FALSE(drive_in(rock(0.24)).mishap);
  // The ball's chord at the clearance of 0.25 m is sqrt(0.5^2 - 0.35^2) to each side.
  check(drive_in(rock(0.4)), Accident::hit, 10 - std::sqrt(0.25 - 0.1225) - 0.8, kStep_m + 0.02);
  const auto branch = [&](double low_m) {
    return with(sim::Kind::branch, box({10, 0, low_m + 0.1}, {0.1, 3, 0.1}));
  };
  CHECK_FALSE(drive_in(branch(1.82)).mishap);
  check(drive_in(branch(1.78)), Accident::hit, 10 - 0.1 - 0.8, kStep_m + 0.01);
}

TEST_CASE("bushes and grass are driven through, and counted once each") {
  sim::WorldData data = level_world();
  add(data, sim::Kind::bush, ball({10, 0, 0.5}, 0.8), 1.0, 0.1);
  add(data, sim::Kind::bush, ball({12, 0.5, 0.5}, 0.8), 1.0, 0.1);
  add(data, sim::Kind::grass, ball({15, 0, 0}, 0.7), 0.7, 0.5);
  add(data, sim::Kind::bush, ball({12, 4, 0.5}, 0.8), 1.0, 0.1);
  const Driven driven = drive_in(std::move(data));
  CHECK_FALSE(driven.mishap);
  CHECK(driven.bushes == 2);
  CHECK(driven.grass == 1);
}

TEST_CASE("a wheel falls into what is deeper than its radius, and into nothing else") {
  sim::WorldData ditch = level_world();
  paint(ditch, {20, -30}, {22, 30}, sim::Surface::hole, -1);
  const Driven driven = drive_in(std::move(ditch));
  // The front wheels, 0.5 m ahead, leave the rim with the end of their tread. The rim is at the last node.
  check(driven, Accident::fell, 19.9 + 0.3 - 0.5, kStep_m + 0.01);
  CHECK(driven.mishap->against == sim::ObjectClass::ditch);

  sim::WorldData shallow = level_world();
  paint(shallow, {20, -30}, {22, 30}, sim::Surface::hole, -0.22);
  CHECK_FALSE(drive_in(std::move(shallow)).mishap);

  sim::WorldData between_wheels = level_world();
  paint(between_wheels, {15, -0.3}, {18, 0.3}, sim::Surface::hole, -1);
  CHECK_FALSE(drive_in(std::move(between_wheels)).mishap);
}

TEST_CASE("a face that rises by more than a wheel's radius is hit, a kerb is climbed") {
  const auto step = [](double height_m) {
    sim::WorldData data = level_world();
    paint(data, {20, -30}, {90, 30}, sim::Surface::ground, height_m);
    paint(data, {20, -30}, {20.3, 30}, sim::Surface::face, height_m);
    return drive_in(std::move(data));
  };
  const Driven driven = step(1);
  // The side of the face rises by 10 m/m from the node at 19.9 m; the tread's front, 0.3 m up, is lifted by
  // 0.3 m.
  check(driven, Accident::hit, 19.96 - 0.3 - 0.5, kStep_m + 0.01);
  CHECK(driven.mishap->against == sim::ObjectClass::step_face);
  CHECK_FALSE(step(0.15).mishap);
}

TEST_CASE("it tips over where its centre of mass leaves the wheels' track") {
  // The cross slope is 0.1 per metre; half the track of 1.1 m over a height of 0.5 m is 1.1.
  const Driven driven = drive_in(shaped_world([](double x, double y) { return 0.1 * std::max(0.0, x) * y; }));
  check(driven, Accident::tipped, 11, 0.1);
}

TEST_CASE("it tips over in a bend that is too tight for its speed, sooner on a slope that leans outwards") {
  // Half the track of 1.1 m over a centre of mass 1.5 m high: 3.6 m/s2. The slope of 0.1 takes 1 m/s2 of it.
  const auto tips = [](double lateral_mps2, double slope) {
    const sim::World world(shaped_world([&](double, double y) { return slope * y; }));
    VehicleModel model = small_vehicle();
    model.centre_of_mass_m = 1.5;
    model.turn_slip = model.side_slip = model.climb_slip = 0;
    Vehicle vehicle(world.terrain(), model, {0, 0, 0});
    Watch watch(world, model);
    std::optional<Mishap> mishap;
    const double speed_mps = 3;
    while (!mishap && vehicle.time_s() < 3.5) {  // it drives 7 m, and turns a little
      const bool fast = vehicle.state().speed_mps > 0.95 * speed_mps;
      vehicle.command(vehicle.time_s(), {speed_mps, fast ? lateral_mps2 / (speed_mps * speed_mps) : 0});
      vehicle.step();
      mishap = watch.look(vehicle);
    }
    return mishap && mishap->what == Accident::tipped;
  };
  CHECK_FALSE(tips(3.2, 0));
  CHECK(tips(4.0, 0));
  CHECK(tips(-4.0, 0));
  CHECK(tips(3.2, 0.1));  // to the left, the left side up
  CHECK_FALSE(tips(-3.2, 0.1));
}

TEST_CASE("it high-centres on what is higher than its clearance between the wheels") {
  const auto ridge = [](double height_m) {
    sim::WorldData data = level_world();
    paint(data, {10, -0.2}, {12, 0.2}, sim::Surface::ground, height_m);
    return drive_in(std::move(data));
  };
  check(ridge(0.3), Accident::high_centred, 10 - 0.5, 0.1 + kStep_m);
  CHECK_FALSE(ridge(0.2).mishap);
}

TEST_CASE("it leaves the world at its edge") {
  const sim::World world(level_world());
  check(drive_on(world, {80, 0, 0}, kSpeed_mps, 12), Accident::left_world, 90, kStep_m + 1e-6);
}

TEST_CASE("it hits a walker; a walker who walks into it while it stands is no accident of its own") {
  sim::WorldData data = level_world();
  add(data, sim::Kind::walker, post(0, 0, 0.25, 1.8));
  data.objects.back().track = {{0, 10, 0}};
  check(drive_in(data), Accident::hit, 10 - 0.25 - 0.8, kStep_m + 0.02);
  data.objects.back().track = {{0, 10, 0}, {5, 0, 0}};
  const sim::World world(std::move(data));
  CHECK_FALSE(drive_on(world, {}, 0, 10).mishap);
}

TEST_CASE("who has walked into it at a stand is hit only when he was out of it since") {
  sim::WorldData data = level_world();
  add(data, sim::Kind::walker, post(0, 0, 0.25, 1.8));
  data.objects.back().track = {{0, 10, 0}, {5, 0, 0}};
  CHECK_FALSE(drive_on(sim::World(data), {}, kSpeed_mps, 8, 6).mishap);
  data.objects.back().track = {{0, 10, 0}, {5, 0, 0}, {6, 6, 0}};
  check(drive_on(sim::World(data), {}, kSpeed_mps, 12, 6), Accident::hit, 6 - 0.25 - 0.8, kStep_m + 0.02);
}

TEST_CASE("a mishap says what, against what, where, when and how fast") {
  const Mishap mishap{Accident::hit, 8.1, {12.34, -4.5, 0.3}, 3.2, 17, sim::ObjectClass::rock};
  CHECK(describe(mishap) == "hit rock 17 at (12.3, -4.5) m after 8.1 s, at 3.2 m/s");
  CHECK(describe({Accident::fell, 2, {1, 2, 0}, 1, -1, sim::ObjectClass::ditch}) ==
        "fell into ditch at (1.0, 2.0) m after 2.0 s, at 1.0 m/s");
}
