// A map that is the truth has no faults; each fault that is put into it is found, as large as it is.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/tools/evaluation_fixture.hpp"

using namespace gvom;
using namespace gvom::evaluation;
using gvom::test::HandMadeMap;
using gvom::test::HandMadeScene;

TEST_CASE("a perfect map of flat ground has no faults and covers all") {
  const HandMadeScene scene;
  const HandMadeMap map(scene.truth);
  const Figures figures = test::judge(scene.facts(), {map.frame(0.0)});
  for (const Figure fault : {Figure::negative_any, Figure::hard_any, Figure::steep_any, Figure::lethal_any,
                             Figure::path_barred_15, Figure::path_barred_30, Figure::height_p95})
    CHECK(figures[fault] == 0.0);
  for (const Figure found : {Figure::coverage_near, Figure::coverage_30, Figure::sight_coverage_30})
    CHECK(figures[found] == 100.0);
  for (const Figure nothing : {Figure::trunks_near, Figure::hole_barred_m, Figure::walker_found,
                               Figure::lethal_found_near, Figure::vegetation_p95})
    CHECK(std::isnan(figures[nothing]));
}

TEST_CASE("a falsely NEGATIVE column counts by its distance, and bars the path where it lies on it") {
  const HandMadeScene scene;
  const SceneFacts facts = scene.facts();
  const auto with_fault_at = [&](double x_m, double y_m) {
    HandMadeMap map(scene.truth);
    map.flags[map.at(scene.column(x_m, y_m))] = kNegative;
    return test::judge(facts, {map.frame(0.0)});
  };
  const Figures near = with_fault_at(10.0, 0.5);
  CHECK(near[Figure::negative_near] > 0.0);
  CHECK(near[Figure::lethal_near] == near[Figure::negative_near]);
  CHECK(near[Figure::hard_near] == 0.0);
  CHECK(near[Figure::negative_any] == Approx(100.0 / (120 * 60)));
  CHECK(near[Figure::path_barred_15] == 100.0);

  const Figures far = with_fault_at(20.0, 0.5);
  CHECK(far[Figure::negative_near] == 0.0);
  CHECK(far[Figure::negative_30] > 0.0);
  CHECK(far[Figure::path_barred_15] == 0.0);
  CHECK(far[Figure::path_barred_30] == 100.0);

  CHECK(with_fault_at(10.0, 1.5)[Figure::path_barred_30] == 0.0);
  CHECK(with_fault_at(35.0, 0.5)[Figure::path_barred_30] == 0.0);
  const Figures behind = with_fault_at(-2.0, 0.5);
  CHECK(behind[Figure::negative_30] == 0.0);
  CHECK(behind[Figure::negative_any] > 0.0);
  CHECK(behind[Figure::path_barred_30] == 0.0);
}

TEST_CASE("the path is barred in as many frames as show it barred") {
  const HandMadeScene scene;
  HandMadeMap map(scene.truth);
  map.flags[map.at(scene.column(10.0, 0.0))] = kSteep;
  // Seen ahead from 0 and 5 m; passed at 15 and 25 m.
  const Figures figures =
      test::judge(scene.facts(), {map.frame(0.0), map.frame(5.0), map.frame(15.0), map.frame(25.0)});
  CHECK(figures[Figure::path_barred_15] == 50.0);
}

TEST_CASE("columns that nobody observed are not judged, and are not covered") {
  const HandMadeScene scene;
  HandMadeMap map(scene.truth);
  for (std::size_t i = 0; i < map.visibility.size(); ++i) {
    map.visibility[i] = 0;
    map.flags[i] = kNegative;
  }
  const Figures figures = test::judge(scene.facts(), {map.frame(0.0)});
  CHECK(std::isnan(figures[Figure::negative_any]));
  CHECK(figures[Figure::coverage_near] == 0.0);
  CHECK(std::isnan(figures[Figure::height_p95]));
}

TEST_CASE("heights are judged where ground was seen, on bare ground and under vegetation apart") {
  HandMadeScene scene;
  const std::size_t bush = scene.column(8.0, 4.0);
  scene.truth.vegetation[bush] = 1;
  HandMadeMap map(scene.truth);
  for (float& height : map.height) height += 0.1F;
  map.height[map.at(bush)] = -0.7F;
  const std::size_t guessed = map.at(scene.column(3.0, 0.0));
  map.height[guessed] = 99.0F;
  map.visibility[guessed] = static_cast<std::uint8_t>(Visibility::ground_assumed);
  const Figures figures = test::judge(scene.facts(), {map.frame(0.0)});
  CHECK(figures[Figure::bare_bias] == Approx(0.1));
  CHECK(figures[Figure::bare_near_p95] == Approx(0.1));
  CHECK(figures[Figure::vegetation_bias] == Approx(-0.7));
  CHECK(figures[Figure::vegetation_median] == Approx(0.7));
  CHECK(figures[Figure::coverage_near] < 100.0);
}

TEST_CASE("trunks are HARD by any column that they touch, rocks and cars column by column") {
  HandMadeScene scene;
  scene.plant(sim::Kind::tree, 8.0, 2.0, 0.1, 6.0);  // on the corner of four columns
  scene.plant(sim::Kind::tree, 9.0, -3.0, 0.2, 6.0);
  scene.plant(sim::Kind::tree, 7.0, -3.0, 0.05, 6.0);  // too thin to be asked for
  const int rock = scene.plant(sim::Kind::rock, 6.2, 4.2, 0.4, 0.8);
  const int stone = scene.plant(sim::Kind::rock, 10.2, 4.2, 0.4, 0.4);
  scene.put(scene.column(6.2, 4.2), ObjectClass::rock, rock);
  scene.put(scene.column(6.6, 4.2), ObjectClass::rock, rock);
  scene.put(scene.column(10.2, 4.2), ObjectClass::rock, stone);
  HandMadeMap map(scene.truth);
  map.flags[map.at(scene.column(7.9, 1.9))] = kHard;
  map.flags[map.at(scene.column(6.2, 4.2))] = kHard;
  map.flags[map.at(scene.column(6.6, 4.2))] = kSteep;
  const Figures figures = test::judge(scene.facts(), {map.frame(0.0), map.frame(1.0)});
  CHECK(figures[Figure::trunks_near] == 50.0);
  CHECK(figures[Figure::trunks_ever] == 50.0);
  CHECK(figures[Figure::rocks_near] == 50.0);
  CHECK(std::isnan(figures[Figure::cars_near]));
}

TEST_CASE("what the sensor cannot see is not asked for") {
  HandMadeScene scene;
  scene.plant(sim::Kind::tree, 8.0, 2.0, 0.1, 6.0);
  const HandMadeMap map(scene.truth);
  const SceneFacts facts = scene.facts();
  Judge judge(facts, {1.7, 0.0125}, [](const auto&, const auto&) { return 1.0; });  // in a box
  judge.add(map.frame(0.0));
  CHECK(std::isnan(judge.result()[Figure::trunks_near]));
  CHECK(std::isnan(judge.result()[Figure::sight_coverage_30]));
  CHECK(judge.result()[Figure::coverage_30] == 100.0);
}

TEST_CASE("bushes are SOFT or HARD; beside a trunk they are not judged, under a crown apart") {
  HandMadeScene scene;
  const int bush = scene.plant(sim::Kind::bush, 8.2, 4.2, 0.5, 1.0);
  const int tree = scene.plant(sim::Kind::tree, 12.2, -4.2, 0.1, 6.0);
  sim::Body crown;
  crown.centre = {12.2, -2.2, 4.0};
  crown.size = {0.6, 0.6, 1.0};
  crown.hits_per_m = 0.35;
  scene.world.objects[static_cast<std::size_t>(tree)].bodies.push_back(crown);
  const std::vector<std::size_t> open{scene.column(8.2, 4.2), scene.column(8.6, 4.2), scene.column(9.0, 4.2)};
  const std::size_t at_trunk = scene.column(12.6, -4.2), under_crown = scene.column(12.2, -2.2);
  for (const std::size_t column : open) scene.put(column, ObjectClass::bush, bush);
  scene.put(at_trunk, ObjectClass::bush, bush);
  scene.put(under_crown, ObjectClass::bush, bush);
  HandMadeMap map(scene.truth);
  map.flags[map.at(open[0])] = kSoft;
  map.flags[map.at(open[1])] = kHard;
  map.flags[map.at(at_trunk)] = kHard;
  map.flags[map.at(under_crown)] = kSoft;
  const Figures figures = test::judge(scene.facts(), {map.frame(0.0)});
  CHECK(figures[Figure::bushes_found] == Approx(100.0 * 2 / 3));
  CHECK(figures[Figure::bushes_soft] == 50.0);
  CHECK(figures[Figure::bushes_hard] == Approx(100.0 / 3));
  CHECK(figures[Figure::crown_bushes_soft] == 100.0);
  CHECK(figures[Figure::crown_bushes_hard] == 0.0);
}

TEST_CASE("a walker who is not shown is missed, and what stays behind is a ghost for as long as it does") {
  HandMadeScene scene;
  const int walker = scene.plant(sim::Kind::walker, 8.2, -4.0, 0.25, 1.8);
  scene.world.objects[static_cast<std::size_t>(walker)].track = {{0.0, 8.2, -4.0}, {4.0, 8.2, 4.0}};  // 2 m/s
  const SceneFacts facts = scene.facts();
  const std::size_t column = scene.column(8.2, -2.2);  // left at (1.8 + 0.3) / 2 = 1.05 s
  HandMadeMap shown(scene.truth), ghost(scene.truth), empty(scene.truth);
  shown.flags[shown.at(scene.column(8.2, -4.0))] = kHard;
  ghost.flags[ghost.at(column)] = kSoft;
  const Figures figures = test::judge(
      facts, {shown.frame(0.0, 0.0), ghost.frame(0.0, 1.75), ghost.frame(0.0, 2.05), empty.frame(0.0, 2.5)});
  CHECK(figures[Figure::walker_found] == 25.0);
  CHECK(figures[Figure::trail_max_s] == Approx(1.0).margin(0.03));
  CHECK(figures[Figure::trail_median_s] == 0.0);
  // The walker's own place is not falsely lethal, and the ghost's is.
  CHECK(test::judge(facts, {shown.frame(0.0, 0.0)})[Figure::lethal_any] == 0.0);
}

TEST_CASE("lethal columns that are found count by any lethal flag") {
  HandMadeScene scene;
  scene.dig(8.0, 9.2, 2.0, 2.4, 1.0);
  HandMadeMap map(scene.truth);
  map.flags[map.at(scene.column(8.2, 2.2))] = kNegative;
  map.flags[map.at(scene.column(8.6, 2.2))] = kSoft;
  CHECK(test::judge(scene.facts(), {map.frame(0.0)})[Figure::lethal_found_near] == Approx(100.0 / 3));
}

TEST_CASE("NEGATIVE out of sight behind the edge of a hole on the way is not judged, in sight it is false") {
  HandMadeScene scene;
  scene.dig(8.0, 10.0, -12.0, 12.0, 1.0);
  HandMadeMap map(scene.truth);
  map.flags[map.at(scene.column(10.6, 3.0))] = kNegative;
  const SceneFacts facts = scene.facts();
  const auto false_share = [&](const Sight& sight) {
    Judge judge(facts, {1.7, 0.0125}, sight);
    judge.add(map.frame(0.0));
    return judge.result()[Figure::negative_near];
  };
  CHECK(false_share(test::open_sight) > 0.0);
  CHECK(false_share([](const auto&, const auto&) { return 1.0; }) == 0.0);
}
