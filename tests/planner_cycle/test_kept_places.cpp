// What was lethal beside the vehicle stays so where nobody looks.
#include "services/planner/kept_places.hpp"

#include <catch2/catch.hpp>

#include "tests/planner_cycle/loop.hpp"

namespace gvom::test {
namespace {

using planner::KeptPlaces;

constexpr double kDitch_x_m = 15, kDitch_y_m = 10;

/// A map of 25.6 m with a ditch across.
struct Ground {
  explicit Ground(double blind_m = 3) : kept(64, blind_m) {}

  SmallMap map{64};
  KeptPlaces kept;
  std::int64_t stamp_ns = 0;

  void set(std::uint8_t flags, Visibility visibility) {
    map.where(box(kDitch_x_m - 0.5, 0, kDitch_x_m + 0.5, 25), [&](std::size_t i) {
      map.flags[i] = flags;
      map.visibility[i] = static_cast<std::uint8_t>(visibility);
    });
  }
  /// Of the ditch's middle, for a vehicle so far before it.
  std::uint8_t look(double away_m, std::int64_t later_ns = 0) {
    stamp_ns += later_ns;
    const planner::MapView view = kept.keep(map.view(stamp_ns), {kDitch_x_m - away_m, kDitch_y_m});
    return view.flags[map.cells().index_of(kDitch_x_m, kDitch_y_m)];
  }
};

TEST_CASE("a hole that is forgotten and assumed to be ground stays one beside the vehicle") {
  Ground ground;
  ground.set(kNegative, Visibility::unobserved);
  CHECK(ground.look(3) == kNegative);
  ground.set(0, Visibility::ground_assumed);
  for (int i = 0; i < 1000; ++i) REQUIRE(ground.look(3) == kNegative);
  ground.set(0, Visibility::free_only);  // rays high above it
  CHECK(ground.look(2) == kNegative);
  ground.set(0, Visibility::ground_seen);
  CHECK(ground.look(2) == 0);
  ground.set(0, Visibility::ground_assumed);
  CHECK(ground.look(2) == 0);
}

TEST_CASE("it is kept as far as the ring of the lidar and a metre") {
  for (const double blind_m : {3.0, 6.2}) {
    Ground ground(blind_m);
    ground.set(kNegative, Visibility::unobserved);
    ground.look(6);
    ground.set(0, Visibility::ground_assumed);
    CHECK(ground.look(6) == (blind_m > 5 ? kNegative : 0));
  }
}

TEST_CASE("what was hard from afar stays hard; what turned hard beside the vehicle only as long as it is") {
  Ground ground;
  ground.set(kHard, Visibility::ground_seen);
  ground.look(8);
  ground.set(0, Visibility::unobserved);
  CHECK(ground.look(3) == kHard);
  Ground anew;
  anew.set(kHard, Visibility::ground_seen);
  CHECK(anew.look(3) == kHard);
  anew.set(0, Visibility::unobserved);
  CHECK(anew.look(3) == 0);
}

TEST_CASE("unless it was hard for two seconds, at any rate of maps: that stands, and who walks by does not") {
  for (const std::int64_t turn_ns : {20'000'000, 37'000'000, 100'000'000, 333'000'000})
    for (const double hard_s : {1.5, 2.5}) {
      Ground ground;
      ground.set(kHard, Visibility::ground_seen);
      const std::int64_t end_ns = static_cast<std::int64_t>(1e9 * hard_s);
      for (std::int64_t at_ns = 0; at_ns < end_ns; at_ns += turn_ns) {
        ground.look(2, turn_ns);
        ground.look(2);  // the same map, in the next cycle
      }
      ground.set(0, Visibility::ground_assumed);
      CAPTURE(turn_ns, hard_s);
      CHECK(ground.look(2, turn_ns) == (hard_s > 2 ? kHard : 0));
      ground.set(0, Visibility::ground_seen);
      CHECK(ground.look(2, turn_ns) == 0);
    }
}

TEST_CASE("a pause between two maps is no time that it stood, and nothing is held for ever") {
  Ground ground;
  ground.set(0, Visibility::ground_assumed);
  ground.look(2);
  ground.set(kHard, Visibility::ground_assumed);
  ground.look(2, 600'000'000'000);
  ground.set(0, Visibility::ground_assumed);
  CHECK(ground.look(2, 100'000'000) == 0);
  ground.set(kHard, Visibility::ground_assumed);
  for (int turn = 0; turn < 30; ++turn) ground.look(2, 100'000'000);
  ground.set(0, Visibility::ground_assumed);
  for (int turn = 0; turn < 290; ++turn) REQUIRE(ground.look(2, 100'000'000) == kHard);
  for (int turn = 0; turn < 20; ++turn) ground.look(2, 100'000'000);
  CHECK(ground.look(2, 100'000'000) == 0);
}

TEST_CASE("who looks for what moves sees holes kept, and nothing that was hard") {
  Ground ground;
  ground.set(kHard | kNegative, Visibility::unobserved);
  for (int turn = 0; turn < 30; ++turn) ground.look(2, 100'000'000);
  ground.set(0, Visibility::unobserved);
  CHECK(ground.look(2, 100'000'000) == (kHard | kNegative));
  const planner::MapView holes = ground.kept.holes(ground.map.view(ground.stamp_ns));
  CHECK(holes.flags[ground.map.cells().index_of(kDitch_x_m, kDitch_y_m)] == kNegative);
}

TEST_CASE("from afar the map alone is right, and a map that begins anew knows nothing") {
  Ground ground;
  ground.set(kHard | kNegative, Visibility::unobserved);
  ground.look(3);
  ground.set(0, Visibility::unobserved);
  CHECK(ground.look(6) == 0);
  CHECK(ground.look(3) == 0);
  ground.set(kNegative, Visibility::unobserved);
  ground.look(3);
  ground.set(0, Visibility::ground_assumed);
  ground.kept.clear();
  CHECK(ground.look(3) == 0);
}

TEST_CASE("it stays where it is when the map moves") {
  Ground ground;
  ground.set(kNegative, Visibility::unobserved);
  ground.look(3);
  SmallMap moved(64, 8 * SmallMap::kCell_m, -8 * SmallMap::kCell_m);
  moved.where(disc(kDitch_x_m, kDitch_y_m, 9), [&](std::size_t i) {
    moved.visibility[i] = static_cast<std::uint8_t>(Visibility::ground_assumed);
  });
  const planner::MapView view = ground.kept.keep(moved.view(), {kDitch_x_m - 3, kDitch_y_m});
  CHECK(view.flags[moved.cells().index_of(kDitch_x_m, kDitch_y_m)] == kNegative);
  CHECK(view.flags[moved.cells().index_of(kDitch_x_m + 1.2, kDitch_y_m)] == 0);
}

TEST_CASE("the planner keeps what its vehicle file says is blind") {
  for (const double blind_m : {3.0, 6.2}) {
    planner::PlannerConfig config;
    config.blind_m = blind_m;
    Ground ground;
    Loop loop(config, ground.map, {kDitch_x_m - 6, kDitch_y_m, 0});
    loop.planner.set_course({{22, kDitch_y_m}});
    ground.set(kNegative, Visibility::unobserved);
    CHECK(loop.step().reason == planner::Reason::no_way);
    ground.set(0, Visibility::ground_assumed);
    ground.map.obstacle(box(14, 0, 16, kDitch_y_m - 3));
    ground.map.obstacle(box(14, kDitch_y_m + 3, 16, 26));
    CHECK((loop.step().reason == planner::Reason::no_way) == (blind_m > 5));
  }
}

}  // namespace
}  // namespace gvom::test
