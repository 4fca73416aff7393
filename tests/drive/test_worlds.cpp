// Worlds can be driven in: a vehicle stands at their start, there usually is a way, and seldom straight on.
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/drive/driven.hpp"
#include "tests/tools/temporary_folder.hpp"
#include "tools/drive/truth_planner.hpp"
#include "tools/drive/worlds.hpp"
#include "tools/sim/world_files.hpp"

using namespace gvom;
using namespace gvom::driving;
using namespace gvom::test;

namespace {

constexpr double kShort_m = 80;

/// A world with its truth.
struct Known {
  explicit Known(CourseWorld the_course)
      : course(std::move(the_course)), world(course.data), truth(sim::sample_truth(world, {0.2})) {}

  CourseWorld course;
  sim::World world;
  sim::GroundTruth truth;
};

bool is_free_straight_on(const TruthPlanner& planner, const CourseWorld& course) {
  Eigen::Vector2d from = course.start.place();
  for (const Eigen::Vector2d& to : course.waypoints_m) {
    for (double part = 0; part <= 1; part += 0.002)
      if (!planner.is_free(from + part * (to - from))) return false;
    from = to;
  }
  return true;
}

double straight_m(const CourseWorld& course) {
  double length_m = 0;
  Eigen::Vector2d from = course.start.place();
  for (const Eigen::Vector2d& to : course.waypoints_m) {
    length_m += (to - from).norm();
    from = to;
  }
  return length_m;
}

}  // namespace

TEST_CASE("campaign worlds 1 to 10 have a start to stand at, and most a way that is not the straight one") {
  int ways = 0, straight = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    INFO("seed " << seed);
    const Known known(make_campaign_world(seed, kShort_m));
    const TruthPlanner planner(known.truth, {});
    CHECK(planner.is_free(known.course.start.place()));
    const Driven standing = drive_on(known.world, known.course.start, 0, 1);
    CHECK_FALSE(standing.mishap);
    ways += planner.plan(known.course.start.place(), known.course.waypoints_m) ? 1 : 0;
    straight += is_free_straight_on(planner, known.course) ? 1 : 0;
  }
  CHECK(ways >= 9);
  CHECK(straight <= 2);
}

TEST_CASE("a campaign's waypoints are 50 to 80 m apart, its start looks at the first") {
  for (const std::uint64_t seed : {3, 4}) {
    const CourseWorld course = make_campaign_world(seed);
    REQUIRE(course.waypoints_m.size() == 5);
    CHECK(course.waypoints_m.back().x() == 300);
    Eigen::Vector2d from = course.start.place();
    for (const Eigen::Vector2d& to : course.waypoints_m) {
      CHECK((to - from).norm() >= 50);
      CHECK((to - from).norm() <= 80);
      from = to;
    }
    CHECK((course.waypoints_m.front() - course.start.place()).normalized().dot(course.start.forward()) ==
          Approx(1));
  }
}

TEST_CASE("a seed gives the same world twice, another seed another one") {
  const CourseWorld once = make_campaign_world(7, kShort_m), again = make_campaign_world(7, kShort_m);
  CHECK(once.data.ground.height_m == again.data.ground.height_m);
  REQUIRE(once.data.objects.size() == again.data.objects.size());
  for (std::size_t i = 0; i < once.data.objects.size(); ++i)
    CHECK(once.data.objects[i].position_m == again.data.objects[i].position_m);
  CHECK(make_campaign_world(8, kShort_m).data.ground.height_m != once.data.ground.height_m);
}

TEST_CASE("the step of test-3 is 1.5 m, too steep ahead, and has a way at its left end") {
  for (const auto& [name, rises_m] : {std::pair("test-3", 1.5), std::pair("test-4", -1.5)}) {
    INFO(name);
    const Known known(*make_test_world(name));
    const sim::Terrain& terrain = known.world.terrain();
    CHECK(terrain.height_m(25.5, 0) - terrain.height_m(24.5, 0) == Approx(rises_m).margin(0.6));
    CHECK(terrain.height_m(45, 0) - terrain.height_m(0, 0) == Approx(rises_m).margin(0.3));
    const TruthPlanner planner(known.truth, {});
    CHECK_FALSE(is_free_straight_on(planner, known.course));
    const auto way = planner.plan(known.course.start.place(), known.course.waypoints_m);
    REQUIRE(way);
    CHECK(way->length_m > straight_m(known.course) + 3);
    const auto leftmost = std::max_element(way->points_m.begin(), way->points_m.end(),
                                           [](const auto& a, const auto& b) { return a.y() < b.y(); });
    CHECK(leftmost->y() > 6);
    CHECK(drive_on(known.world, known.course.start, 3, 30).mishap);
  }
}

TEST_CASE("test-1 and test-2 are long courses with a way that is longer than the straight one") {
  for (const char* name : {"test-1", "test-2"}) {
    INFO(name);
    const Known known(*make_test_world(name));
    CHECK(straight_m(known.course) > 240);
    const auto way = TruthPlanner(known.truth, {}).plan(known.course.start.place(), known.course.waypoints_m);
    REQUIRE(way);
    CHECK(way->length_m > straight_m(known.course));
  }
  CHECK(make_test_world("test-5").error() ==
        "test-5: no such test; there are test-1, test-2, test-3 and test-4");
}

TEST_CASE("a world from files is driven along its path") {
  const TemporaryFolder folder;
  sim::WorldData data = level_world();
  data.path_m = {{1, 2}, {4, 6}, {20, 6}};
  REQUIRE(sim::save_world(data, folder.path() + "/meadow"));
  const auto course = read_course_world(folder.path() + "/meadow/");
  REQUIRE(course);
  CHECK(course->name == "meadow");
  CHECK(course->start.place() == Eigen::Vector2d(1, 2));
  CHECK(course->start.yaw_rad == Approx(std::atan2(4, 3)));
  CHECK(course->waypoints_m == std::vector<Eigen::Vector2d>{{4, 6}, {20, 6}});
  CHECK_FALSE(read_course_world(folder.path()));
}
