// Ten short worlds, each with something else in the way: the reference planner arrives and touches nothing.
// Each is a test of its own (CMakeLists.txt), so that they run side by side.
#include <algorithm>

#include <catch2/catch.hpp>

#include "services/common/config_file.hpp"
#include "tests/tools/sim_worlds.hpp"
#include "tools/drive/cli/campaign.hpp"
#include "tools/sim/noise.hpp"
#include "tools/sim/scenes/things.hpp"

using namespace gvom;
using namespace gvom::driving;
using gvom::test::level_world;

namespace {

constexpr double kLength_m = 40;

struct Task {
  std::uint64_t seed;
  std::string vehicle = "warthog";
  std::vector<double> noise{0.02, 0.002};  // of the odometry: metres, radians
  std::vector<std::string> sets{};
};

bool has(const CourseWorld& world, sim::Kind kind, int least) {
  int count = 0;
  for (const sim::Object& object : world.data.objects) count += object.kind == kind ? 1 : 0;
  return count >= least;
}

bool has(const CourseWorld& world, sim::Surface surface) {
  const auto& all = world.data.ground.surface;
  return std::find(all.begin(), all.end(), surface) != all.end();
}

/// Level ground with rocks of 0.27 to 0.34 m everywhere: a Warthog's clearance is 0.254 m.
CourseWorld low_rocks(std::uint64_t seed) {
  CourseWorld course;
  course.data = level_world();
  course.waypoints_m = {{kLength_m, 0}};
  sim::Random random(seed);
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d foot(random.between(6, kLength_m - 2), random.between(-9, 9), 0);
    const double radius_m = random.between(0.25, 0.4);
    course.data.objects.push_back(sim::make_rock(random, foot, radius_m, random.between(0.27, 0.34)));
  }
  return course;
}

void arrives(const Task& task, const CourseWorld& world) {
  const auto config =
      services::load_vehicle_config(GVOM_SOURCE_DIR "/config/vehicles/" + task.vehicle + ".yaml", task.sets);
  REQUIRE(config);
  SessionOptions options;
  options.seed = task.seed;
  options.sensor = sensor_of(*config);
  options.odometry_noise = {task.noise[0], task.noise[1]};
  auto result = run_session(world, *config, options);
  REQUIRE(result);
  const Row row{world.name, task.seed, std::move(*result)};
  INFO(line_of(row));
  CHECK_FALSE(row.result.log.mishap);
  CHECK(row.result.outcome == Outcome::arrived);
  CHECK(row.result.log.nearest_m > 0);
  REQUIRE(row.result.way);
  CHECK(row.result.log.seconds() > row.result.way->seconds);  // who knows the world is quicker
  const Eigen::Vector2d end = row.result.log.steps.back().place.place();
  CHECK((end - world.waypoints_m.back()).norm() < config->planner.goal_tolerance_m + 0.1);
}

/// Drives a random world, once `is_it` says that it is what the test is about.
template <class Question>
void arrives(const Task& task, const Question& is_it) {
  const CourseWorld world = make_campaign_world(task.seed, kLength_m);
  REQUIRE(is_it(world));
  arrives(task, world);
}

const auto kAny = [](const CourseWorld&) { return true; };

}  // namespace

TEST_CASE("a ditch across the way", "[ditch]") {
  arrives({18}, [](const CourseWorld& world) { return has(world, sim::Surface::hole); });
}

TEST_CASE("a bank across the way", "[bank]") {
  arrives({4}, [](const CourseWorld& world) { return has(world, sim::Surface::face); });
}

TEST_CASE("a walker who crosses the way again and again", "[walker]") {
  arrives({32}, [](const CourseWorld& world) { return has(world, sim::Kind::walker, 1); });
}

TEST_CASE("a wood", "[wood]") {
  arrives({6}, [](const CourseWorld& world) { return has(world, sim::Kind::tree, 100); });
}

TEST_CASE("dust", "[dust]") {
  arrives({15}, [](const CourseWorld& world) { return has(world, sim::Kind::dust, 2); });
}

TEST_CASE("rocks little higher than its clearance", "[rocks]") {
  arrives({5}, low_rocks(5));
}

TEST_CASE("odometry that is off by 5 cm and 5 mrad", "[noise]") {
  arrives({33, "warthog", {0.05, 0.005}}, kAny);
}

TEST_CASE("the Moose, among rocks", "[moose]") {
  arrives({52, "moose"}, [](const CourseWorld& world) { return has(world, sim::Kind::rock, 75); });
}

TEST_CASE("the Ranger, that may drive at 12 m/s", "[ranger]") {
  arrives({50, "ranger", {0.02, 0.002}, {"planner.speed_mps=12"}}, kAny);
}

TEST_CASE("a Warthog with two lidars, in bushes", "[two]") {
  arrives({23, "warthog_two"}, [](const CourseWorld& world) { return has(world, sim::Kind::bush, 100); });
}
