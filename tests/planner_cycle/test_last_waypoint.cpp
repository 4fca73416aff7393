// The last waypoint, wherever it lies beside the vehicle: within its turning circle too.
#include <catch2/catch.hpp>

#include <random>

#include "tests/planner_cycle/loop.hpp"

namespace gvom::test {
namespace {

using Eigen::Vector2d;
using planner::Mode;

// Seconds until it says that it has arrived, by odometry that is off by 2 cm (1 sigma), of a vehicle that
// turns an eighth less than it is told to; +infinity: never.
double arrival_s(const planner::PlannerConfig& config, const Vector2d& waypoint_m, unsigned seed) {
  SmallMap map(128);
  SmallVehicle vehicle(config.vehicle, {25, 25, 0});
  planner::Planner planner(config, map.cells().n);
  planner.set_course({waypoint_m});
  std::mt19937 random(seed);
  std::normal_distribution<double> noise_m(0, 0.02);
  for (double at_s = 0; at_s < 60; at_s += 1 / config.rate_hz) {
    planner::State state = vehicle.state();
    state.T_odom_base.translation_m += Eigen::Vector3d(noise_m(random), noise_m(random), 0);
    const planner::MapView view = map.view(state.stamp_ns);
    const planner::Plan& plan = planner.cycle(&view, state, {});
    if (plan.mode == Mode::arrived) return at_s;
    vehicle.drive({plan.command.speed_mps, plan.command.curvature_per_m * 7 / 8}, 1 / config.rate_hz);
  }
  return std::numeric_limits<double>::infinity();
}

// A Warthog's turning circle, and a Ranger's, which also steers slowly.
TEST_CASE("It arrives at a last waypoint beside it, within its turning circle too") {
  for (const double curvature_per_m : {0.7, 0.23})
    for (const double away_m : {1.6, 3.0})
      for (int degrees = -180; degrees < 180; degrees += 30) {
        planner::PlannerConfig config;
        config.vehicle.max_curvature_per_m = curvature_per_m;
        if (curvature_per_m < 0.3) config.vehicle.max_curvature_rate_per_m_s = 0.25;
        const double angle = degrees * 3.14159265358979 / 180;
        const Vector2d waypoint_m(25 + away_m * std::cos(angle), 25 + away_m * std::sin(angle));
        const double seconds = arrival_s(config, waypoint_m, 1);
        CAPTURE(curvature_per_m, away_m, degrees, seconds);
        CHECK(seconds < 30);
      }
}

}  // namespace
}  // namespace gvom::test
