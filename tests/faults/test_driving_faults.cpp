// What fails while the vehicle drives at 4.5 m/s: it stands within its stopping distance and what it takes to
// notice, touches nothing, and goes on when all is back.
#include <catch2/catch.hpp>

#include <functional>

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
constexpr int kTries = 3;                   // a machine that pauses may spoil two
constexpr double kDrivesOn_m = 15;          // more than it takes to stop

/// What fails, what cures it, and after how long the vehicle hears of it at the latest.
struct Fault {
  const char* name;
  double heard_s;
  std::function<void(DriveLab&)> break_it, cure_it;
  bool is_quick = false;  ///< Also where faults are not made to happen often.
};

const Fault kFaults[] = {
    {"driving: the planner is killed", kDeadline_s, [](DriveLab& lab) { lab.planner->kill_asleep(); },
     [](DriveLab& lab) { lab.planner = lab.start_planner(); }, true},
    {"driving: the lidar dies", kMaxAge_s, [](DriveLab& lab) { lab.board->lidar = false; },
     [](DriveLab& lab) { lab.board->lidar = true; }, true},
    {"driving: fusion is killed", kMaxAge_s, [](DriveLab& lab) { lab.graph->fusion().kill_asleep(); },
     [](DriveLab& lab) { lab.graph->start_fusion(); }},
    {"driving: odometry stops", kOdometrySilence_s, [](DriveLab& lab) { lab.board->odometry = false; },
     [](DriveLab& lab) { lab.board->odometry = true; }},
    {"driving: odometry jumps by 3 m", kCycle_s,
     [](DriveLab& lab) { lab.board->jump_m = 3 - lab.board->jump_m; }, [](DriveLab&) {}, true},
    {"driving: the planner hangs", kDeadline_s, [](DriveLab& lab) { lab.planner->send(SIGSTOP); },
     [](DriveLab& lab) { lab.planner->send(SIGCONT); }},
};

/// The broker is in nobody's way: what is on the bus stays there.
void hang_broker(DriveLab& lab) {
  REQUIRE(lab.drives());
  lab.graph->roudi().send(SIGSTOP);
  const double before_m = lab.board->driven_m;
  const auto begin = std::chrono::steady_clock::now();
  CHECK(gvom::ipc::test::eventually([&] { return lab.board->driven_m > before_m + kDrivesOn_m; }));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  lab.graph->roudi().send(SIGCONT);
  CHECK(lab.drives());
  char seen[96];
  std::snprintf(seen, sizeof seen, "nothing: it drives on, %.0f m in %.1f s", kDrivesOn_m, took.count());
  report("driving: the broker hangs", seen, 0, "");
}

/// The vehicle stands within the distance that it may roll, in one of `kTries`.
void check(DriveLab& lab, const Fault& fault) {
  bool in_time = false;
  for (int i = 0; i < kTries && !in_time; ++i) {
    const Stop stop = lab.check_stop(
        fault.name, [&] { fault.break_it(lab); }, [&] { fault.cure_it(lab); });
    in_time = stop.rolled_m < lab.may_roll_m(stop.speed_mps, fault.heard_s + kCycle_s + kBusy_s);
    UNSCOPED_INFO(fault.name << ": rolled " << stop.rolled_m << " m in " << stop.seconds
                             << " s: " << stop.words);
  }
  CHECK(in_time);
}

}  // namespace

TEST_CASE("faults at 4.5 m/s: each ends at a stand in time, nothing is touched, and the drive goes on") {
  const bool quick = repeats(0) == 0;
  DriveLab lab;
  hang_broker(lab);
  for (const Fault& fault : kFaults) {
    if (!quick || fault.is_quick) check(lab, fault);
  }
  CHECK(lab.board->deadlines_passed >= 1);  // of the planner's last command
  CHECK(lab.board->nearest_m > 0.3);
  lab.stop();
}

TEST_CASE("a simulated vehicle whose broker is killed says so and is to be started again") {
  const TemporaryFolder folder;
  const std::string port = std::to_string(free_port());
  Graph graph({GVOM_SOURCE_DIR "/config/vehicles/warthog.yaml",
               {"top"},
               folder.path(),
               {"lidars.top.source=ouster-udp:" + port + "?meta=campaign-1.json"}});
  const auto vehicle = graph.start("gvom-drive", {"--real-time", "--length", "60", "--out", folder.path()});
  REQUIRE(vehicle->says("the vehicle stands at its start", 120s));
  graph.roudi().kill();
  CHECK(vehicle->wait() == 75);
  CHECK(vehicle->says("the broker is gone", 0s));
}
