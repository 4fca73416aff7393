// What moves in the map, and how the planner keeps off it.
#include "services/planner/movers.hpp"

#include <catch2/catch.hpp>
#include <optional>

#include "tests/planner_cycle/loop.hpp"
#include "tests/planner_cycle/walker.hpp"

namespace gvom::test {
namespace {

using Eigen::Vector2d;
using planner::Mode;
using planner::Movers;
using planner::Plan;
using planner::PlannerConfig;

constexpr std::int64_t kTurn_ns = 100'000'000;

/// Movers as a planner of the map sees them.
struct Sight {
  explicit Sight(SmallMap& a_map) : map(a_map), movers({}, a_map.cells().n, 2) {}

  void look(double speed_mps = 0, const Vector2d& from_m = {10, 10}) {
    stamp_ns += turn_ns;
    movers.observe(map.view(stamp_ns), from_m, speed_mps);
  }
  /// The column (x, y) alone has this flag, of all.
  void look_at(int x, int y, std::uint8_t flag) {
    map.flags.assign(map.flags.size(), 0);
    map.flags[static_cast<std::size_t>(y * 64 + x)] = flag;
    look();
  }

  SmallMap& map;
  Movers movers;
  std::int64_t stamp_ns = 1'000'000'000;
  std::int64_t turn_ns = kTurn_ns;
};

TEST_CASE("what walks is closed as far as it gets until the vehicle is there or stands") {
  for (const std::uint8_t flag : {kHard, kSoft}) {
    SmallMap map(64);
    Sight sight(map);
    // 2 m/s along x, at y = 10.2 m: from turn 6 on a past is old enough, 0.6 m on from there it moves.
    for (int turn = 0; turn < 10; ++turn) sight.look_at(30 + turn / 2, 25, flag);
    CHECK(sight.movers.empty());
    sight.look_at(35, 25, flag);
    sight.look_at(35, 25, flag);
    const Vector2d middle_m(35.5 * 0.4, 10.2);
    REQUIRE(sight.movers.discs().size() == 3);  // standing: a second, 1.4 m
    CHECK(sight.movers.discs()[0].middle_m.isApprox(middle_m));
    CHECK(sight.movers.discs()[0].radius_m == 1);
    CHECK(sight.movers.discs()[2].middle_m.isApprox(Vector2d(middle_m + Vector2d(1.4, 0))));
    CHECK(sight.movers.discs()[2].radius_m == Approx(1.42));
    // 4.2 m away. At 4 m/s the vehicle is there in 1.05 s, and at a stand in 0.3 + 4 / 2.5 = 1.9 s: 1.47 m.
    sight.look(4);
    REQUIRE(sight.movers.discs().size() == 3);
    CHECK(sight.movers.discs()[2].middle_m.x() ==
          Approx(middle_m.x() + 1.4 * (middle_m - Vector2d(10, 10)).norm() / 4));
    // Gone from the map, it is believed to be there for 1.2 s after it got on, from half a second on anywhere
    // around.
    map.flags.assign(map.flags.size(), 0);
    for (int turn = 0; turn < 5; ++turn) sight.look();
    REQUIRE(sight.movers.discs().size() == 1);
    CHECK(sight.movers.discs()[0].middle_m.isApprox(middle_m));
    CHECK(sight.movers.discs()[0].radius_m == Approx(1 + 1.4 * (1 + 0.5)));
    for (int turn = 0; turn < 5; ++turn) sight.look();
    CHECK(sight.movers.discs().size() == 1);
    for (int turn = 0; turn < 3; ++turn) sight.look();
    CHECK(sight.movers.empty());
  }
}

TEST_CASE("who is lost beside the vehicle is waited for until he has had time to go by") {
  for (const double beside_m : {2.5, 3.5}) {
    SmallMap map(64);
    Sight sight(map);
    for (int turn = 0; turn < 12; ++turn) sight.look_at(30 + turn / 2, 25, kHard);
    REQUIRE_FALSE(sight.movers.empty());
    map.flags.assign(map.flags.size(), 0);
    const Vector2d from_m(35.5 * 0.4, 10.2 - beside_m);
    for (int turn = 0; turn < 28; ++turn) sight.look(0, from_m);
    CHECK(sight.movers.empty() == (beside_m > 3));
    for (int turn = 0; turn < 5; ++turn) sight.look(0, from_m);
    CHECK(sight.movers.empty());
  }
}

TEST_CASE(
    "what is before who walks is SOFT: it costs to pass there; for who brakes all that he can reach is") {
  SmallMap map(64);
  Sight sight(map);
  for (int turn = 0; turn < 12; ++turn) sight.look_at(20 + turn / 2, 25, kHard);
  const auto flag = [&](const planner::MapView& view, double ahead_m) {
    return view.flags[view.cells().index_of(25.5 * 0.4 + ahead_m, 10.2)];
  };
  const planner::MapView seen = map.view(sight.stamp_ns);
  CHECK((flag(sight.movers.close(seen), 1) & kHard) != 0);
  CHECK(flag(sight.movers.close(seen), 4) == kSoft);
  CHECK(flag(sight.movers.close(seen), 10) == 0);
  CHECK(flag(sight.movers.close(seen), -2) == 0);
  CHECK(flag(sight.movers.discourage(seen), 1) == kSoft);
  CHECK(flag(sight.movers.discourage(seen), 0) == (kHard | kSoft));
  CHECK(flag(sight.movers.discourage(seen), 4) == 0);
}

TEST_CASE("he is seen to walk at any rate of maps, and by each of them once") {
  for (const int per_turn : {1, 2, 5, 10}) {
    SmallMap map(64);
    Sight sight(map);
    sight.turn_ns = kTurn_ns / per_turn;
    for (int turn = 0; turn < 12 * per_turn; ++turn) {
      sight.look_at(30 + turn / per_turn / 2, 25, kHard);
      for (int again = 0; again < 3; ++again) sight.movers.observe(map.view(sight.stamp_ns), {10, 10}, 0);
    }
    CAPTURE(per_turn);
    CHECK(sight.movers.discs().size() == 3);
  }
}

TEST_CASE("what shows itself late, by turns or piece by piece stays in its place") {
  SmallMap map(64);
  Sight sight(map);
  for (int turn = 0; turn < 40; ++turn) {
    const bool shows = turn % 13 > 6;
    map.flags[25 * 64 + 30] = shows ? kHard : 0;
    map.flags[25 * 64 + 31] = shows && turn % 2 == 0 ? kHard : 0;
    if (turn % 2 == 0)
      map.flags[static_cast<std::size_t>(35 * 64 + 20 + turn / 2)] = kSoft;  // a row of grass
    sight.look();
    CAPTURE(turn);
    REQUIRE(sight.movers.empty());
  }
}

TEST_CASE("what stands and comes into sight, and an edge that flickers by a cell, do not move") {
  SmallMap map(64);
  Sight sight(map);
  const auto trunk = static_cast<std::size_t>(25 * 64 + 30);
  const auto wall = static_cast<std::size_t>(30 * 64);
  map.visibility[trunk] = 0;
  for (int turn = 0; turn < 40; ++turn) {
    if (turn == 10) map.flags[trunk] = kHard;
    if (turn == 12) map.visibility[trunk] = static_cast<std::uint8_t>(Visibility::ground_seen);
    for (std::size_t x = 0; x < 64; ++x) {
      map.flags[wall + x] = kHard;
      map.flags[wall - 64 + x] = (turn * 7 + x) % 3 == 0 ? kHard : 0;
    }
    sight.look();
    CAPTURE(turn);
    REQUIRE(sight.movers.empty());
  }
}

TEST_CASE("beside other things only what gets on twice, straight on, moves") {
  SmallMap map(64);
  map.where(box(6, 10.7, 20, 13), [&](std::size_t i) { map.flags[i] = kSoft; });
  const std::vector<std::uint8_t> hedge = map.flags;
  Sight sight(map);
  int first = -1;
  for (int turn = 0; turn < 30 && first < 0; ++turn) {
    map.flags = hedge;
    map.flags[static_cast<std::size_t>(25 * 64 + 22 + turn / 2)] = kSoft;  // 2 m/s, a metre beside it
    sight.look();
    if (!sight.movers.empty()) first = turn;
  }
  CHECK(first > 12);  // alone it is turn 10
  CHECK(first <= 18);
}

/// Turns in which the vehicle waits, of the first `kPatience_ns`, and of as many after that. Then it gets on.
struct Waits {
  int first = 0, then = 0, later = 0;
};

template <class Step>
Waits waits_for(SmallMap& map, Step place_m) {
  Sight sight(map);
  const std::vector<std::uint8_t> others = map.flags;
  const auto show = [&](int turn) {
    map.flags = others;
    const std::optional<Vector2d> at_m = place_m(turn);
    if (at_m) map.flags[static_cast<std::size_t>(map.cells().index_of(at_m->x(), at_m->y()))] = kSoft;
  };
  constexpr int kTurns = Movers::kPatience_ns / kTurn_ns;
  Waits waits;
  for (int turn = 0, waited = 0; turn < 40 * kTurns; ++turn) {
    show(turn);
    sight.look();
    if (sight.movers.empty()) continue;
    ++(waited++ < kTurns ? waits.first : waits.then);
    sight.movers.wait({10, 10}, sight.stamp_ns);
  }
  for (int turn = 0; turn < 4 * kTurns; ++turn) {
    show(turn);
    sight.look(0, {10, 11.5});
    waits.later += sight.movers.empty() ? 0 : 1;
  }
  return waits;
}

TEST_CASE("what flickers on beside others is waited for five seconds, a walker as long as he walks") {
  SmallMap hedged(64);
  hedged.where(box(6, 10.7, 20, 13), [&](std::size_t i) { hedged.flags[i] = kSoft; });
  const Waits grass = waits_for(hedged, [](int turn) -> std::optional<Vector2d> {
    const int at = turn % 40;  // 1.6 m along it at 2 m/s, then nothing
    if (at >= 8) return std::nullopt;
    return Vector2d(9 + 0.2 * at, 10.2);
  });
  CHECK(grass.first > 40);
  CHECK(grass.then == 0);
  CHECK(grass.later > 0);
  SmallMap open(64);
  const Waits walker = waits_for(open, [](int turn) -> std::optional<Vector2d> {
    return Vector2d(12 + std::abs(3 - 0.14 * (turn % 43)), 10.2);
  });
  CHECK(walker.first == 50);
  CHECK(walker.then > 1000);
}

TEST_CASE("the rim of a hole that shows itself piece by piece does not move, nor does a long thing") {
  for (const bool hole : {true, false}) {
    SmallMap map(64);
    Sight sight(map);
    if (hole) map.where(box(14, 4, 14.8, 22), [&](std::size_t i) { map.flags[i] = kNegative; });
    for (int turn = 0; turn < 40; ++turn) {
      // 2 m/s along the hole; or a side of 6 m, 1.2 m of it in sight at once, each 0.3 s.
      if (hole)
        map.flags[static_cast<std::size_t>((10 + turn / 2) * 64 + 37)] = kHard;
      else if (turn >= 10)
        map.obstacle(box(12, 4.0 + 1.2 * ((turn - 10) / 3), 12.8, 5.2 + 1.2 * ((turn - 10) / 3)));
      sight.look();
      CAPTURE(hole, turn);
      REQUIRE(sight.movers.empty());
    }
  }
}

}  // namespace
}  // namespace gvom::test
