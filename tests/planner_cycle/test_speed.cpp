// How fast a trajectory may be driven, in computed answers.
#include <catch2/catch.hpp>

#include "services/planner/speed.hpp"
#include "tests/planner_cycle/small_map.hpp"

namespace gvom::test {
namespace {

using planner::End;
using planner::PlannerConfig;
using planner::Reason;
using planner::SpeedLimits;
using planner::SpeedProfile;
using planner::TrajectoryPoint;

constexpr double kStep_m = 0.25;

struct Drive {
  PlannerConfig config;
  SmallMap map{128};
  std::vector<TrajectoryPoint> trajectory;

  // Straight along x from (5, 25), 12 m.
  Drive() {
    for (int i = 0; i <= 48; ++i) {
      TrajectoryPoint point;
      point.pose = {5 + i * kStep_m, 25, 0};
      trajectory.push_back(point);
    }
  }
  SpeedLimits make(double speed_mps, double seen_m = 12, End end = End::horizon) {
    SpeedProfile profile(config, trajectory.size());
    return profile.make(map.view(), speed_mps, seen_m, end, trajectory);
  }
};

TEST_CASE("On a free straight it accelerates and can stop at the end") {
  Drive drive;
  drive.make(1);
  // v^2 = 1 + 2 * 1.5 * s; v^2 = 2 * 0.8 * 2.5 * (12 - s).
  CHECK(drive.trajectory[8].speed_mps == Approx(std::sqrt(1 + 3 * 2.0)));
  CHECK(drive.trajectory[44].speed_mps == Approx(std::sqrt(4 * 1.0)));
  CHECK(drive.trajectory.back().speed_mps == 0);
  CHECK(drive.trajectory[20].speed_mps == Approx(std::sqrt(1 + 3 * 5.0)));
}

TEST_CASE("A curve of 4 m is driven at the root of lateral acceleration over curvature") {
  Drive drive;
  for (std::size_t i = 0; i < drive.trajectory.size(); ++i) drive.trajectory[i].curvature_per_m = 0.25;
  const SpeedLimits limits = drive.make(4.5);
  CHECK(drive.trajectory[0].speed_mps == Approx(std::sqrt(2.0 / 0.25)));
  CHECK(limits.reasons[0] == Reason::curve);
}

TEST_CASE("Where the curvature changes it drives no faster than it can steer") {
  Drive drive;
  for (std::size_t i = 20; i < drive.trajectory.size(); ++i) drive.trajectory[i].curvature_per_m = 0.2;
  drive.make(4.5);
  CHECK(drive.trajectory[20].speed_mps == Approx(1.0 * kStep_m / 0.2));  // 1.25 m/s, where it could drive 3.2
}

TEST_CASE("Bumps of 0.1 m are driven at 3.5 m/s") {
  Drive drive;
  for (float& roughness : drive.map.roughness) roughness = 0.01F;
  const SpeedLimits limits = drive.make(4.5);
  CHECK(drive.trajectory[0].speed_mps ==
        Approx(4 / (2 * 3.14159265358979) * std::sqrt(3 / 0.1)).epsilon(1e-4));
  CHECK(limits.reasons[0] == Reason::rough);
}

TEST_CASE("At three quarters of the limit of roll it drives half way between its speed and creeping") {
  Drive drive;
  for (TrajectoryPoint& point : drive.trajectory) point.roll_rad = 0.75 * 0.4;
  const SpeedLimits limits = drive.make(4.5);
  CHECK(drive.trajectory[0].speed_mps == Approx((4.5 + 0.5) / 2));
  CHECK(limits.reasons[0] == Reason::steep);
}

TEST_CASE("Downhill it brakes for longer") {
  Drive flat, down;
  for (TrajectoryPoint& point : down.trajectory) point.pitch_rad = 0.1;
  flat.make(4.5);
  down.make(4.5);
  CHECK(flat.trajectory[40].speed_mps == Approx(std::sqrt(2 * 2.0 * 2)));
  CHECK(down.trajectory[40].speed_mps == Approx(std::sqrt(2 * (2.0 - 9.81 * std::sin(0.1)) * 2)));
}

TEST_CASE("It can stop within what is seen, latency included") {
  for (const double seen_m : {3.0, 5.0, 8.0, 11.5}) {
    Drive drive;
    const SpeedLimits limits = drive.make(5, seen_m);
    for (std::size_t i = 0; static_cast<double>(i) * kStep_m < seen_m - 2.2; ++i) {
      const double v = drive.trajectory[i].speed_mps, at_m = static_cast<double>(i) * kStep_m;
      if (v <= 0.5) continue;  // creeps
      CHECK(v * 0.3 + v * v / (2 * 2.0) <= seen_m - 2.0 - at_m + 1e-9);
    }
    CHECK(limits.reasons[0] == (seen_m < 10 ? Reason::unseen_ground : Reason::none));
    CHECK(limits.creeps_to_m == Approx(seen_m - 1));
    // It creeps until a metre before, and not on.
    const auto before = static_cast<std::size_t>((seen_m - 1.5) / kStep_m);
    const auto end = static_cast<std::size_t>((seen_m - 1) / kStep_m);
    CHECK(drive.trajectory[before].speed_mps == Approx(0.5));
    CHECK(drive.trajectory[end].speed_mps == 0);
  }
}

TEST_CASE("What ends a trajectory is why it is slow before its end") {
  for (const auto& [end, reason] :
       {std::pair{End::goal, Reason::near_goal}, std::pair{End::blocked, Reason::no_trajectory},
        std::pair{End::horizon, Reason::none}}) {
    Drive drive;
    const SpeedLimits limits = drive.make(4.5, 12, end);
    CHECK(limits.reasons[44] == reason);
    CHECK(limits.reason_places_m[44] == Approx(12.0));
    CHECK(limits.reasons[0] == Reason::none);
  }
}

}  // namespace
}  // namespace gvom::test
