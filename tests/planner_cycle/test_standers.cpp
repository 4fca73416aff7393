// Who stood alone and sets off is told before he is in the way; what stands is not.
#include "services/planner/standers.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <optional>

#include "services/planner/lone.hpp"
#include "tests/planner_cycle/walker.hpp"

namespace gvom::test {
namespace {

using Eigen::Vector2d;
using planner::Standers;

constexpr std::int64_t kTurn_ns = 100'000'000;
constexpr double kPersonRadius_m = 0.25;

/// Columns that a person there touches are SOFT.
void put_person(SmallMap& map, const Vector2d& middle_m) {
  map.where(touched_by(middle_m, kPersonRadius_m, map.cells().cell_m),
            [&](std::size_t i) { map.flags[i] = kSoft; });
}

struct Told {
  double time_s = 0;
  Vector2d direction{0, 0};
};

/// What is told first of a world that `paint(map, time_s)` makes anew for each map.
std::optional<Told> told(const std::function<void(SmallMap&, double)>& paint, double cell_m = 0.4,
                         std::int64_t turn_ns = kTurn_ns) {
  SmallMap map(static_cast<int>(25.6 / cell_m + 0.5), 0, 0, cell_m);
  Standers standers;
  for (std::int64_t now_ns = 0; now_ns <= 6'000'000'000; now_ns += turn_ns) {
    map.flags.assign(map.flags.size(), 0);
    const double time_s = 1e-9 * static_cast<double>(now_ns);
    paint(map, time_s);
    const auto& set_off = standers.observe(map.view(now_ns), {12, 8}, 15);
    if (!set_off.empty()) return Told{time_s, set_off.front().direction};
  }
  return std::nullopt;
}

/// Stands at (12.4, 12.4) until `first_s`, then walks.
auto person(double first_s, const Vector2d& velocity_mps) {
  return [=](SmallMap& map, double time_s) {
    put_person(map, Vector2d(12.4, 12.4) + velocity_mps * std::max(0.0, time_s - first_s));
  };
}

TEST_CASE("who stood for a second and sets off is told within 0.7 s, and which way he goes") {
  for (const double cell_m : {0.2, 0.4})
    for (const std::int64_t turn_ns : {25'000'000, 50'000'000, 100'000'000})
      for (const double walks_mps : {1.2, 1.4, 2.0})
        for (int way = 0; way < 12; ++way) {
          const Vector2d direction(std::cos(way * 0.5236), std::sin(way * 0.5236));
          const auto first = told(person(2, walks_mps * direction), cell_m, turn_ns);
          CAPTURE(cell_m, turn_ns, walks_mps, way);
          REQUIRE(first.has_value());
          CHECK(first->time_s <= 2 + (cell_m < 0.3 ? 0.45 : 0.7));
          CHECK(first->direction.dot(direction) > 0.8);
        }
}

TEST_CASE("what stands is not told: a post, one whose edge flickers, one that comes into sight") {
  CHECK_FALSE(told(person(9, {0, 0})));
  for (const int each : {1, 2, 3, 5, 8}) {
    CAPTURE(each);
    CHECK_FALSE(told([&](SmallMap& map, double time_s) {
      const int turn = static_cast<int>(time_s / 0.1 + 0.5);
      map.obstacle(box(12, 12, 12.8, 12.8));
      if (turn / each % 2 == 0) map.obstacle(box(12.8, 12, 13.2, 12.8));
    }));
    CHECK_FALSE(told([&](SmallMap& map, double time_s) {  // by turns, 0.8 m apart
      const int turn = static_cast<int>(time_s / 0.1 + 0.5);
      map.obstacle(turn / each % 2 == 0 ? disc(12.2, 12.2, 0.1) : disc(13, 12.2, 0.1));
    }));
  }
}

TEST_CASE("what shows more of itself on one side, or less, has not set off") {
  for (const double cell_m : {0.2, 0.4})
    for (const double wide_m : {0.4, 0.6})
      for (const double more_m : {0.4, 0.6, 0.8})
        for (const bool first_small : {true, false}) {
          CAPTURE(cell_m, wide_m, more_m, first_small);
          CHECK_FALSE(told(
              [&](SmallMap& map, double time_s) {
                const bool small = (std::fmod(time_s, 3) < 2) == first_small;
                map.obstacle(box(12, 12, 12 + wide_m + (small ? 0 : more_m), 12.4));
              },
              cell_m));
        }
}

TEST_CASE("who did not stand before, goes slowly, or stands beside something is not told here") {
  CHECK_FALSE(told(person(0.5, {1.4, 0})));
  CHECK_FALSE(told(person(2, {0.3, 0})));
  CHECK_FALSE(told([&](SmallMap& map, double time_s) {
    map.obstacle(box(10, 13.4, 16, 14));
    person(2, {1.4, 0})(map, time_s);
  }));
  CHECK_FALSE(told([&](SmallMap& map, double time_s) {
    const double x_m = 10 + 1.4 * std::max(0.0, time_s - 2);  // a car
    map.obstacle(box(x_m, 12, x_m + 3, 13.6));
  }));
}

TEST_CASE("a lone thing is found by its middle, what is beside it or is larger is none") {
  SmallMap map(64);
  const auto find = [&] {
    std::vector<Vector2d> found;
    planner::for_each_lone(map.view(), {12, 12}, 10,
                           [&](const planner::Lone& lone) { found.push_back(lone.middle_m); });
    return found;
  };
  CHECK(find().empty());
  map.obstacle(box(12, 12, 12.8, 12.8));
  REQUIRE(find().size() == 1);
  CHECK((find().front() - Vector2d(12.4, 12.4)).norm() < 1e-9);
  map.obstacle(box(16, 12, 18, 14));
  CHECK(find().size() == 1);
  map.obstacle(box(13.2, 12, 13.6, 12.4));
  CHECK(find().empty());
}

}  // namespace
}  // namespace gvom::test
