// Holes on the path: how wide, how deep, and from where a map bars every way into them.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/tools/evaluation_fixture.hpp"
#include "tools/sim/scene_library.hpp"

using namespace gvom;
using namespace gvom::evaluation;
using gvom::test::HandMadeMap;
using gvom::test::HandMadeScene;

TEST_CASE("a ditch across the path has its width, its depth, its rim and nine lanes") {
  HandMadeScene scene;
  scene.dig(30.0, 31.9, -12.0, 12.0, 1.0);
  const SceneFacts facts = scene.facts();
  REQUIRE(facts.holes.size() == 1);
  const Hole& hole = facts.holes[0];
  CHECK(hole.rim_driven_m == Approx(29.95).margin(0.06));
  CHECK(hole.width_m == Approx(2.0).margin(0.01));
  CHECK(hole.depth_m == Approx(1.0));
  CHECK_FALSE(hole.open);
  CHECK(hole.lanes.size() == 9);
}

TEST_CASE("an oblique ditch is as wide as it is along the path, not across a whole lane") {
  HandMadeScene scene;
  for (int i = -110; i < 110; ++i)  // turned by 45 degrees
    scene.dig(30.0 + 0.1 * i, 31.9 + 0.1 * i, 0.1 * i - 0.01, 0.1 * i + 0.01, 1.0);
  REQUIRE(scene.facts().holes.size() == 1);
  CHECK(scene.facts().holes[0].width_m == Approx(2.0).margin(0.25));
  CHECK_FALSE(scene.facts().holes[0].open);
  CHECK(scene.facts().holes[0].lanes[4].far_rim_m - scene.facts().holes[0].lanes[4].rim_m > 2.8);
}

TEST_CASE("a cliff has no far side, a dip is no hole, and a hole beside the path is nobody's") {
  HandMadeScene cliff;
  cliff.dig(35.0, 44.0, -12.0, 12.0, 5.0);
  REQUIRE(cliff.facts().holes.size() == 1);
  CHECK(cliff.facts().holes[0].open);
  HandMadeScene dip;
  dip.dig(30.0, 32.0, -12.0, 12.0, 0.3);
  CHECK(dip.facts().holes.empty());
  HandMadeScene beside;
  beside.dig(30.0, 32.0, 2.0, 12.0, 1.0);
  CHECK(beside.facts().holes.empty());
}

TEST_CASE("a hole beyond the end of the path counts up to 6 m") {
  HandMadeScene scene;
  scene.dig(43.0, 43.9, -12.0, 12.0, 1.0);
  REQUIRE(scene.facts().holes.size() == 1);
  CHECK(scene.facts().holes[0].rim_driven_m == Approx(42.95).margin(0.06));
}

TEST_CASE("the scene of potholes has one that counts, whatever the seed") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    sim::SceneParameters parameters;
    parameters.seed = seed;
    const sim::WorldData world = sim::build_scene("potholes", parameters).value();
    std::vector<Eigen::Vector2d> path_m;
    for (int i = 0; i <= 600; ++i) path_m.emplace_back(0.1 * i, 0.0);
    const std::vector<Hole> holes = find_holes(world.ground, path_m);
    REQUIRE(holes.size() == 1);
    CHECK(holes[0].depth_m == Approx(0.6).margin(0.001));
    CHECK(holes[0].rim_driven_m == Approx(39.45).margin(0.11));  // its side runs over 0.2 m
  }
}

TEST_CASE("a pothole has only the lanes that run into it") {
  HandMadeScene scene;
  scene.dig(20.0, 21.0, -0.5, 0.5, 0.6);
  const SceneFacts facts = scene.facts();
  REQUIRE(facts.holes.size() == 1);
  CHECK(facts.holes[0].lanes.size() == 3);
  CHECK(facts.holes[0].width_m == Approx(1.1).margin(0.01));
}

TEST_CASE("what the geometry allows") {
  // TRUTH: a ditch of 2 m seen from 1.7 m with beams 0.7 degrees apart: 16.7 m.
  CHECK(range_allowed_m(2.0, 1.7, 0.7 * M_PI / 180.0) == Approx(16.68).margin(0.01));
}

TEST_CASE("barred from the farthest frame from which on all nearer ones bar") {
  CHECK(barred_from_m({{20.0, true}, {15.0, false}, {10.0, true}, {5.0, true}}) == 10.0);
  CHECK(barred_from_m({{10.0, true}, {5.0, false}}) == 0.0);
  CHECK(barred_from_m({{12.0, true}}) == 12.0);
  CHECK(std::isnan(barred_from_m({})));
}

TEST_CASE("the way is barred if every lane has something lethal between or just beside the rims") {
  HandMadeScene scene;
  scene.dig(30.0, 31.9, -12.0, 12.0, 1.0);
  const SceneFacts facts = scene.facts();
  const auto barred = [&](double x_m, double gap_y_m, std::uint8_t flag) {
    HandMadeMap map(scene.truth);
    for (double y_m = -5.0; y_m < 5.0; y_m += 0.4)
      if (std::abs(y_m - gap_y_m) > 1.1) map.flags[map.at(scene.column(x_m, y_m))] = flag;
    const Figures figures = test::judge(facts, {map.frame(18.0), map.frame(20.0), map.frame(26.0)});
    return figures[Figure::hole_barred_m];
  };
  CHECK(barred(30.5, 99.0, kNegative) == Approx(11.95).margin(0.06));
  CHECK(barred(29.4, 99.0, kSteep) == Approx(11.95).margin(0.06));
  CHECK(barred(28.8, 99.0, kSteep) == 0.0);    // too far before the rim
  CHECK(barred(30.5, 99.0, kSoft) == 0.0);     // not lethal
  CHECK(barred(30.5, 2.0, kNegative) == 0.0);  // a way of 2 m is left
}
