// What was soft from afar stays so beside the vehicle; what was hard does not become soft.
#include "services/planner/soft_places.hpp"

#include <catch2/catch.hpp>
#include <optional>

#include "tests/planner_cycle/loop.hpp"

namespace gvom::test {
namespace {

using planner::Mode;
using planner::SoftPlaces;

constexpr double kBush_x_m = 15, kBush_y_m = 10.2;

/// Where nothing is kept.
planner::MapView soften(SoftPlaces& soft, const planner::MapView& map, const Eigen::Vector2d& vehicle_m) {
  return soft.soften(map, map, vehicle_m);
}

/// A bush of five columns across, which the map has as `flag`.
void place_bush(SmallMap& map, std::uint8_t flag) {
  std::fill(map.flags.begin(), map.flags.end(), std::uint8_t{0});
  map.where(disc(kBush_x_m, kBush_y_m, 0.9), [&](std::size_t i) { map.flags[i] = flag; });
}

/// Drives towards the bush from 8 to 2 m; the map has each column `afar` until 2.8 m from it, then `near`.
/// @return the flags of the bush's middle at the end
std::uint8_t flags_beside(std::uint8_t afar, std::uint8_t near) {
  SmallMap map(64);
  SoftPlaces soft(64, 3);
  planner::MapView view;
  std::int64_t stamp_ns = 0;
  for (double away_m = 8; away_m >= 2; away_m -= 0.3) {
    const Eigen::Vector2d vehicle_m(kBush_x_m - away_m, kBush_y_m);
    place_bush(map, afar);
    const auto turned = [&](double x, double y) {
      return disc(kBush_x_m, kBush_y_m, 0.9)(x, y) && disc(vehicle_m.x(), vehicle_m.y(), 2.8)(x, y);
    };
    map.where(turned, [&](std::size_t i) { map.flags[i] = near; });
    view = soften(soft, map.view(++stamp_ns), vehicle_m);
  }
  return view.flags[map.cells().index_of(kBush_x_m, kBush_y_m)];
}

TEST_CASE("a bush stays soft beside the vehicle, a rock hard, and who steps in from open ground hard") {
  CHECK(flags_beside(kSoft, kHard) == kSoft);
  CHECK(flags_beside(kSoft, kSoft) == kSoft);
  CHECK(flags_beside(kHard, kHard) == kHard);
  CHECK(flags_beside(0, kHard) == kHard);
}

TEST_CASE("what became hard before it was near is hard, and so is what was never seen from afar") {
  SmallMap map(64);
  SoftPlaces soft(64, 3);
  const int middle = map.cells().index_of(kBush_x_m, kBush_y_m);
  std::int64_t stamp_ns = 0;
  const auto look = [&](std::uint8_t flag, double away_m) {
    place_bush(map, flag);
    return soften(soft, map.view(++stamp_ns), {kBush_x_m - away_m, kBush_y_m}).flags[middle];
  };
  for (int i = 0; i < SoftPlaces::kSure; ++i) look(kSoft, 6);
  look(kHard, 5);
  CHECK(look(kHard, 2) == kHard);
  for (int i = 0; i < SoftPlaces::kSure; ++i) look(kSoft, 6);
  CHECK(look(kHard, 2) == kSoft);
  soft.clear();
  CHECK(look(kHard, 2) == kHard);
}

TEST_CASE("a map that is looked at again counts once") {
  SmallMap map(64);
  SoftPlaces soft(64, 3);
  place_bush(map, kSoft);
  for (int i = 0; i < 2 * SoftPlaces::kSure; ++i) soften(soft, map.view(1), {kBush_x_m - 6, kBush_y_m});
  place_bush(map, kHard);
  const planner::MapView view = soften(soft, map.view(2), {kBush_x_m - 2, kBush_y_m});
  CHECK(view.flags[map.cells().index_of(kBush_x_m, kBush_y_m)] == kHard);
}

TEST_CASE("what was soft is known by its place when the map moves on") {
  SoftPlaces soft(64, 3);
  for (int i = 0; i < SoftPlaces::kSure; ++i) {
    SmallMap before(64);
    place_bush(before, kSoft);
    soften(soft, before.view(i), {kBush_x_m - 6, kBush_y_m});
  }
  SmallMap after(64, 2.4, -1.6);
  place_bush(after, kHard);
  const planner::MapView view = soften(soft, after.view(SoftPlaces::kSure), {kBush_x_m - 2, kBush_y_m});
  CHECK(view.flags[after.cells().index_of(kBush_x_m, kBush_y_m)] == kSoft);
}

/// Through a band of grass that turns hard nearer than `hard_m` to the vehicle.
/// @return the slowest that it went on the way there; nothing: it did not arrive
std::optional<double> slowest_through_grass_mps(double blind_m, double hard_m) {
  planner::PlannerConfig config;
  config.blind_m = blind_m;
  SmallMap map(128);
  Loop loop(config, map, {5, 25, 0});
  loop.planner.set_course({{44, 25}});
  const auto grass = box(23, 0, 26, 52);
  double slowest_mps = 1e9;
  const bool arrives = loop.until(Mode::arrived, 30, [&](const planner::Plan&) {
    const planner::Pose2& pose = loop.vehicle.pose();
    const auto near = disc(pose.x_m, pose.y_m, hard_m);
    map.where(grass, [&](std::size_t i) { map.flags[i] = kSoft; });
    map.where([&](double x, double y) { return grass(x, y) && near(x, y); },
              [&](std::size_t i) { map.flags[i] = kHard; });
    if (pose.x_m > 15 && pose.x_m < 35) slowest_mps = std::min(slowest_mps, loop.vehicle.speed_mps());
  });
  return arrives ? std::optional(slowest_mps) : std::nullopt;
}

TEST_CASE("the vehicle drives through grass that turns hard within its lidars' blind ring, not beyond that") {
  CHECK(slowest_through_grass_mps(3, 2.5).value_or(0) > 3);
  CHECK(slowest_through_grass_mps(6, 5.5).value_or(0) > 3);
  CHECK_FALSE(slowest_through_grass_mps(3, 5.5));
}

TEST_CASE("what is kept as hard is softened, too, and says nothing of what was seen") {
  SmallMap map(64), kept(64);
  map.where(disc(kBush_x_m, kBush_y_m, 0.8), [&](std::size_t i) { map.flags[i] = kSoft; });
  kept.obstacle(disc(kBush_x_m, kBush_y_m, 0.8));
  SoftPlaces soft(64, 3);
  const int middle = map.cells().index_of(kBush_x_m, kBush_y_m);
  for (int i = 1; i <= SoftPlaces::kSure; ++i)
    soft.soften(kept.view(i), map.view(i), {kBush_x_m - 3.5, kBush_y_m});
  CHECK(soft.soften(kept.view(9), map.view(9), {kBush_x_m - 2, kBush_y_m}).flags[middle] == kSoft);
}

}  // namespace
}  // namespace gvom::test
