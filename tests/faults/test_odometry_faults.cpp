// Odometry that fails under live sensors: no map of it is wrong.
#include <catch2/catch.hpp>

#include "tests/faults/lab.hpp"

using namespace gvom::test;
using gvom::ipc::test::eventually;
using namespace std::chrono_literals;

namespace {

constexpr char kFront[] = "gvom-ingest-front";

void check(Lab& lab, const char* name, OdometryMode mode, const char* words) {
  lab.check_fault(
      name, kFront, words, [&] { lab.board->odometry = mode; },
      [&] { lab.board->odometry = OdometryMode::well; });
  CHECK(lab.board->wrong_maps == 0);
}

/// In a gap; or, with a machine that pauses, a queue that was full or waited in for too long.
std::uint64_t dropped_sweeps(const Lab& lab) {
  std::uint64_t sum = 0;
  for (const char* counter : {"drop_odometry_gap", "drop_overrun", "drop_odometry_timeout"})
    sum += lab.observer->counter(kFront, counter);
  return sum;
}

/// Whether no pose is lost while layers flow. A pause of seconds loses some: hence three tries.
bool takes_all_poses(const Lab& lab) {
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t lost = lab.observer->counter(kFront, "odometry_lost");
    CHECK(lab.layers_flow(40));
    if (lab.observer->counter(kFront, "odometry_lost") == lost) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("in a gap nothing is mapped, before and after it everything") {
  Lab lab;
  for (int round = 0; round < repeats(1); ++round) {
    const std::uint64_t dropped = dropped_sweeps(lab);
    lab.check_fault(
        "no odometry for 1.5 s", kFront, "no odometry for",
        [&] {
          lab.board->odometry = OdometryMode::silent;
          CHECK(eventually([&] { return lab.board->gap_end_ns == kNoEnd; }));
          std::this_thread::sleep_for(500ms);
        },
        [&] { lab.board->odometry = OdometryMode::well; });
    CHECK(eventually([&] { return dropped_sweeps(lab) >= dropped + 10; }));
    CHECK(eventually([&] { return lab.observer->counter(kFront, "drop_odometry_gap") > 0; }));
    CHECK(lab.layers_flow());
    CHECK(lab.board->maps_in_gap == 0);
  }
  CHECK(lab.board->wrong_maps == 0);
  lab.stop();
}

TEST_CASE("after a jump the map has nothing from before it") {
  Lab lab;
  for (int round = 0; round < repeats(2); ++round) {
    const bool there = round % 2 == 0;
    const auto jumps = static_cast<std::uint64_t>(round) + 1;
    lab.check_fault(
        there ? "odometry jumps by 5 m" : "odometry jumps back", kFront,
        round == 0 ? "odometry jumped by 5.0 m" : "odometry jumped by 4.0 m",
        [&] { lab.board->odometry = there ? OdometryMode::moved : OdometryMode::returned; }, [] {});
    CHECK(eventually([&] { return lab.observer->counter("gvom-fusion", "odometry_jumps") == jumps; }));
    CHECK(lab.layers_flow());
    CHECK(lab.observer->newest_layers().T_odom_base.position_m[0] == (there ? kMoved_m : kReturned_m));
    CHECK(lab.board->wrong_maps == 0);
  }
  lab.stop();
}

TEST_CASE("poses that are none, or go back in time, or come ten times as often make no map wrong") {
  Lab lab;
  check(lab, "every other pose is NaN", OdometryMode::not_finite, "odometry is not a pose");
  check(lab, "odometry goes back in time", OdometryMode::backwards, "odometry goes back in time");
  CHECK(lab.observer->counter(kFront, "drop_odometry_gap") == 0);

  lab.board->odometry = OdometryMode::fast;
  CHECK(takes_all_poses(lab));
  CHECK(eventually([&] { return lab.is_ok(kFront); }));
  report("odometry at 200 Hz", "nothing", 0, "");
  CHECK(lab.board->wrong_maps == 0);
  lab.stop();
}

TEST_CASE("a lidar whose clock is not the odometry's is not mapped, and Health says how far it is off") {
  Lab lab;
  struct Clock {
    const char* fault;
    std::int64_t ahead_s;
    const char* words;
  };
  for (const Clock& clock :
       {Clock{"the lidar's clock 10 s behind", -10, "s behind the odometry's"},
        Clock{"the lidar's clock is TAI", 37, "s ahead of the odometry's (that is TAI - UTC)"},
        Clock{"the lidar's clock is Unix time", 1'700'000'000, "(the odometry's counts from its boot)"}}) {
    std::uint64_t mapped = 0;
    std::uint64_t mapped_meanwhile = 0;
    lab.check_fault(
        clock.fault, kFront, clock.words, [&] { lab.board->front_ahead_ns = clock.ahead_s * 1'000'000'000; },
        [&] {
          mapped = lab.observer->counter(kFront, "sweeps_mapped");
          const std::uint64_t refused = lab.observer->counter(kFront, "drop_clock_offset");
          CHECK(
              eventually([&] { return lab.observer->counter(kFront, "drop_clock_offset") >= refused + 10; }));
          mapped_meanwhile = lab.observer->counter(kFront, "sweeps_mapped");
          lab.board->front_ahead_ns = 0;
        });
    CHECK(mapped_meanwhile == mapped);
  }
  CHECK(lab.board->wrong_maps == 0);
  lab.stop();
}

TEST_CASE("with odometry at 1 Hz nothing is mapped, and Health says why") {
  Lab lab;
  check(lab, "odometry at 1 Hz", OdometryMode::slow, "gap of 1.0");
  lab.stop();
}
