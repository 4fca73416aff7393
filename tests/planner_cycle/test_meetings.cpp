// Whole drives in which the vehicle meets somebody.
#include <catch2/catch.hpp>

#include "tests/planner_cycle/loop.hpp"
#include "tests/planner_cycle/walker.hpp"

namespace gvom::test {
namespace {

using Eigen::Vector2d;
using planner::Mode;
using planner::Plan;

/// Drives from x = 5 to 45 m, and hits nobody while it is faster than `stands_mps`. Where the walker is, by
/// the time. Nobody in its way, the vehicle is at x = 25 m after 3 s * 2.25 m/s and (20 - 6.75) m / 4.5 m/s:
/// `kThere_s`.
constexpr double kThere_s = 5.9;

template <class Place>
void meets(std::uint8_t flag, double stands_mps, Place place_m) {
  SmallMap map(128);
  Walker walker(map, flag);
  Loop loop({}, map, {5, 25, 0});
  loop.planner.set_course({{45, 25}});
  double time_s = 0, nearest_m = 1e9;
  const auto step = [&] {
    walker.stand_at(place_m(time_s));
    time_s += 0.1;
  };
  step();
  const bool arrives = loop.until(Mode::arrived, 30, [&](const Plan&) {
    step();
    if (loop.vehicle.speed_mps() > stands_mps) nearest_m = std::min(nearest_m, walker.away_m(loop.vehicle));
  });
  CAPTURE(int{flag}, nearest_m, time_s, loop.vehicle.pose().x_m);
  CHECK(arrives);
  CHECK(nearest_m > 0.1);
  CHECK(time_s < 26);
}

TEST_CASE("the vehicle does not hit who crosses its way, and drives on when he is by") {
  for (const std::uint8_t flag : {kHard, kSoft})
    for (const double walks_mps : {1.0, 1.4, 1.8})
      for (double early_s = -2.5; early_s <= 2.5; early_s += 0.5) {
        CAPTURE(walks_mps, early_s);
        meets(flag, 0.05,
              [&](double time_s) { return Vector2d(25, 25 + walks_mps * (time_s + early_s - kThere_s)); });
      }
}

// By the way, 1 to 2 m beside the vehicle's side; it stops within 6 m from where it is told.
TEST_CASE("nor who stood by its way, and steps into it when it is ten metres away") {
  for (const std::uint8_t flag : {kHard, kSoft})
    for (const double beside_m : {2.0, 2.5, 3.0})
      for (const double away_m : {10.0, 11.0, 12.0}) {
        CAPTURE(beside_m, away_m);
        const double sets_off_s = kThere_s - away_m / 4.5;
        meets(flag, 0.05, [&](double time_s) {
          return Vector2d(25, 25 - beside_m + 1.4 * std::clamp(time_s - sets_off_s, 0.0, 10.0));
        });
      }
}

// Who turns 4 m before it and is not told at once walks into it while it brakes, slower than he walks.
TEST_CASE("nor who has crossed it, turns around and crosses it again") {
  for (const std::uint8_t flag : {kHard, kSoft})
    for (const double walks_mps : {1.0, 1.4})
      for (const double beyond_m : {2.0, 2.5, 3.0, 4.0})
        for (double early_s = -1; early_s <= 1; early_s += 0.5) {
          CAPTURE(walks_mps, beyond_m, early_s);
          const double turns_s = kThere_s - early_s - beyond_m / walks_mps;
          meets(flag, walks_mps, [&](double time_s) {
            return Vector2d(25, 25 + beyond_m - walks_mps * std::abs(time_s - turns_s));
          });
        }
}

TEST_CASE("a vehicle that somebody never lets pass gives up") {
  planner::PlannerConfig config;
  config.give_up_s = 10;
  SmallMap map(64);
  map.obstacle([](double x, double y) { return x > 14 && x < 14.8 && std::abs(y - 12) > 1.6; });
  Walker walker(map, kHard);
  Loop loop(config, map, {8, 12, 0});
  loop.planner.set_course({{22, 12}});
  double time_s = 0;
  const auto walks = [&](const Plan&) {
    time_s += 0.1;
    walker.stand_at({13.2, 12 + std::abs(2 - std::fmod(time_s, 4)) - 1});
  };
  CHECK_FALSE(loop.until(Mode::gave_up, 30, walks));
  CHECK(loop.until(Mode::gave_up, 30, walks));
}

}  // namespace
}  // namespace gvom::test
