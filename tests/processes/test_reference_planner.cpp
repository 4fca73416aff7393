// gvom-planner on the bus: it drives a vehicle to its goal, and brings it to a stand when what it needs is
// not there, or it itself is not.
#include <catch2/catch.hpp>

#include <cmath>
#include <fstream>

#include "services/common/config_file.hpp"
#include "tests/processes/flat_world.hpp"
#include "tests/processes/observer.hpp"
#include "tests/processes/recordings.hpp"
#include "tests/tools/temporary_folder.hpp"

using namespace gvom;
using namespace gvom::test;
using ipc::PlanMode;
using ipc::test::eventually;

namespace {

/// A broker, the flat world and the planner.
struct Rig {
  explicit Rig(const std::vector<std::string>& sets = {}) : graph(vehicle(sets)) {}

  TemporaryFolder folder;
  Graph graph;
  Observer observer{folder.path()};
  FlatWorld world{services::load_vehicle_config(graph.vehicle().file, graph.vehicle().sets).value()};
  std::unique_ptr<Program> planner = start();

  [[nodiscard]] Vehicle vehicle(const std::vector<std::string>& sets) const {
    Vehicle made = front_only(folder.path());
    made.sets.insert(made.sets.end(), sets.begin(), sets.end());
    return made;
  }
  std::unique_ptr<Program> start(const std::vector<std::string>& more = {}) {
    return graph.start("gvom-planner", more);
  }
  void end() {
    world.leave();
    graph.stop();
  }
  [[nodiscard]] bool drives() const {
    return eventually([&] { return world.speed_mps() > 1.0; });
  }
  [[nodiscard]] bool stands() const {
    return eventually([&] { return world.speed_mps() == 0; });
  }
  /// Commands go on coming.
  [[nodiscard]] bool is_commanded() const {
    return eventually([&, before = world.commands()] { return world.commands() > before + 5; });
  }
  [[nodiscard]] bool says(const std::string& words) const {
    return eventually([&] { return world.why().find(words) != std::string::npos; });
  }
  [[nodiscard]] bool is(ipc::HealthState state, const std::string& words = "") const {
    return eventually([&] {
      const auto health = observer.health("gvom-planner");
      return health && health->state == static_cast<std::uint32_t>(state) &&
             std::string(health->reason).find(words) != std::string::npos;
    });
  }
};

}  // namespace

TEST_CASE("the planner drives to a goal that the bus gives it, and stops there") {
  Rig rig;
  REQUIRE(rig.world.is_up());
  CHECK(rig.says("course"));
  CHECK(rig.is(ipc::HealthState::ok));
  CHECK(rig.world.speed_mps() == 0);
  rig.world.send_course(12, 0);
  CHECK(rig.drives());
  CHECK(eventually([&] { return rig.world.mode() == PlanMode::arrived; }));
  CHECK(rig.stands());
  CHECK(std::abs(rig.world.x_m() - 12) < 1.5);
  CHECK(rig.is_commanded());
  CHECK(rig.planner->stop() == 0);
  rig.end();
}

TEST_CASE("it stops, says why, and goes on: without layers, without odometry, with a blind side") {
  Rig rig;
  REQUIRE(rig.world.is_up());
  rig.world.send_course(1000, 0);
  REQUIRE(rig.drives());
  rig.world.let_layers(false);
  CHECK(rig.stands());
  CHECK(rig.says("layers"));
  CHECK(rig.is_commanded());  // to stand still
  CHECK(rig.is(ipc::HealthState::degraded, "layers"));
  rig.world.let_layers(true);
  CHECK(rig.drives());
  CHECK(rig.is(ipc::HealthState::ok));

  rig.world.let_odometry(false);
  CHECK(rig.stands());
  CHECK(rig.says("no odometry"));
  CHECK(rig.is_commanded());
  rig.world.let_odometry(true);
  CHECK(rig.drives());

  rig.world.lose_front(true);
  CHECK(rig.stands());
  CHECK(rig.says("lidar"));
  CHECK(rig.is_commanded());
  rig.world.lose_front(false);
  CHECK(rig.drives());
  CHECK(rig.planner->stop() == 0);
  rig.end();
}

TEST_CASE("it stops where its own cycle takes too long") {
  Rig rig({"map.size_xy=1024", "map.size_z=8",
           "planner.rate_hz=100"});  // more columns than can be planned over in 10 ms
  REQUIRE(rig.world.is_up());
  rig.world.send_course(1000, 0);
  CHECK(rig.says("the last cycle took"));
  CHECK(rig.planner->stop() == 0);
  rig.end();
}

TEST_CASE("a planner that is killed leaves a deadline, and its successor goes on") {
  Rig rig;
  REQUIRE(rig.world.is_up());
  rig.world.send_course(1000, 0);
  REQUIRE(rig.drives());
  const std::uint64_t passed = rig.world.deadlines_passed();
  rig.planner->kill_asleep();
  CHECK(rig.stands());
  CHECK(rig.world.deadlines_passed() == passed + 1);

  rig.planner = rig.start();  // the bus still has the course
  CHECK(rig.drives());
  CHECK(rig.planner->stop() == 0);
  CHECK(rig.stands());
  rig.end();
}

TEST_CASE(
    "of a course of several places the successor drives to the one that comes next, of a new one to the "
    "first") {
  Rig rig;
  REQUIRE(rig.world.is_up());
  rig.world.send_course({{8, 0}, {1000, 0}});
  REQUIRE(eventually([&] { return rig.world.waypoint() == 1; }));
  rig.planner->kill_asleep();
  REQUIRE(rig.stands());
  const double killed_m = rig.world.x_m();
  rig.planner = rig.start();
  REQUIRE(rig.drives());
  CHECK(rig.world.waypoint() == 1);
  CHECK(rig.planner->says(", 1 of them reached before this start"));
  CHECK(eventually([&] { return rig.world.x_m() > killed_m + 3; }));

  CHECK(rig.planner->stop() == 0);
  rig.world.send_course({{8, 0}, {1000, 0}});  // the same places, meant anew
  rig.planner = rig.start();
  CHECK(rig.planner->says("a course of 2 places"));
  CHECK(eventually([&] { return rig.world.waypoint() == 0; }));
  CHECK(rig.planner->stop() == 0);
  rig.end();
}

TEST_CASE("a course may be a file, and one that is none ends the start") {
  Rig rig;
  REQUIRE(rig.world.is_up());
  CHECK(eventually([&] { return rig.world.commands() > 0; }));
  CHECK(rig.planner->stop() == 0);
  std::ofstream(rig.folder.path() + "/course.csv") << "x_m,y_m\n6,0\n";
  rig.planner = rig.start({"--course", "course.csv"});
  CHECK(eventually([&] { return rig.world.mode() == PlanMode::arrived; }));
  CHECK(rig.planner->stop() == 0);
  std::ofstream(rig.folder.path() + "/course.csv") << "6;0\n";
  CHECK(rig.start({"--course", "course.csv"})->wait() == 65);
  rig.end();
}
