// What fails while the vehicle drives at 4.5 m/s: it stands within its stopping distance and what it takes to
// notice, touches nothing, and goes on when all is back.
#include <catch2/catch.hpp>

#include "tests/faults/drive_lab.hpp"

using namespace gvom::test;
using namespace std::chrono_literals;

namespace {

// How long it may take until a command to stand is given, or none holds any more.
constexpr double kCycle_s = 0.1;
constexpr double kDeadline_s = 0.25;        // of a command: two and a half cycles
constexpr double kOdometrySilence_s = 0.3;  // then the planner stops
constexpr double kMaxAge_s = 0.5;           // of layers: planner.max_age_s
constexpr double kBusy_s = 0.15;            // two cores that simulate, map and plan

}  // namespace

TEST_CASE("faults at 4.5 m/s: each ends at a stand in time, nothing is touched, and the drive goes on") {
  DriveLab lab;
  const auto rolls_at_most = [&](const Stop& stop, double heard_s) {
    INFO("rolled " << stop.rolled_m << " m in " << stop.seconds << " s: " << stop.words);
    CHECK(stop.rolled_m < lab.may_roll_m(stop.speed_mps, heard_s + kCycle_s + kBusy_s));
  };
  rolls_at_most(lab.check_stop(
                    "driving: the planner is killed", [&] { lab.planner->kill_asleep(); },
                    [&] { lab.planner = lab.start_planner(); }),
                kDeadline_s);
  CHECK(lab.board->deadlines_passed == 1);
  rolls_at_most(
      lab.check_stop(
          "driving: the lidar dies", [&] { lab.board->lidar = false; }, [&] { lab.board->lidar = true; }),
      kMaxAge_s);
  rolls_at_most(lab.check_stop(
                    "driving: fusion is killed", [&] { lab.graph->fusion().kill_asleep(); },
                    [&] { lab.graph->start_fusion(); }),
                kMaxAge_s);
  rolls_at_most(lab.check_stop(
                    "driving: odometry stops", [&] { lab.board->odometry = false; },
                    [&] { lab.board->odometry = true; }),
                kOdometrySilence_s);
  rolls_at_most(lab.check_stop(
                    "driving: odometry jumps by 3 m", [&] { lab.board->jump_m = 3; }, [] {}),
                kCycle_s);
  rolls_at_most(lab.check_stop(
                    "driving: the planner hangs", [&] { lab.planner->send(SIGSTOP); },
                    [&] { lab.planner->send(SIGCONT); }),
                kDeadline_s);
  CHECK(lab.board->nearest_m > 0.3);
  lab.stop();
}

TEST_CASE("a broker that hangs for two seconds does not stop the drive") {
  DriveLab lab;
  REQUIRE(lab.drives());
  lab.graph->roudi().send(SIGSTOP);
  const double before_m = lab.board->driven_m;
  std::this_thread::sleep_for(2s);
  const double driven_m = lab.board->driven_m - before_m;
  lab.graph->roudi().send(SIGCONT);
  CHECK(driven_m > 4);
  CHECK(lab.drives());
  CHECK_FALSE(lab.board->mishap);
  char seen[96];
  std::snprintf(seen, sizeof seen, "nothing: it drives on, %.1f m in 2 s", driven_m);
  report("driving: the broker hangs for 2 s", seen, 0, "");
  lab.stop();
}
