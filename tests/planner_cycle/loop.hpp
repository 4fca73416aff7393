// Planner and vehicle on a map that does not change, or that shows itself as the vehicle comes near.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "services/planner/planner.hpp"
#include "tests/planner_cycle/small_map.hpp"
#include "tests/planner_cycle/small_vehicle.hpp"

namespace gvom::test {

struct Loop {
  Loop(const planner::PlannerConfig& config, SmallMap& a_map, const planner::Pose2& start)
      : map(a_map),
        vehicle(config.vehicle, start),
        planner(config, a_map.cells().n),
        period_s(1 / config.rate_hz) {}

  /// One cycle, and the vehicle's way until the next.
  const planner::Plan& step() {
    planner::State state = vehicle.state();
    state.stamp_ns += ahead_ns;
    if (falls_back_each > 0 && ++cycles % falls_back_each == 0) state.stamp_ns -= falls_back_ns;
    const planner::MapView view = map.view(state.stamp_ns);
    const planner::Plan& plan = planner.cycle(&view, state, senses);
    vehicle.drive(plan.command, period_s);
    senses.odometry_jumped = false;
    return plan;
  }
  /// Until the plan's mode is this, at most so long; after each step `look`. @return whether it came to be
  bool until(planner::Mode mode, double seconds, const std::function<void(const planner::Plan&)>& look = {}) {
    for (double at_s = 0; at_s < seconds; at_s += period_s) {
      const planner::Plan& plan = step();
      if (look) look(plan);
      if (plan.mode == mode) return true;
    }
    return false;
  }

  SmallMap& map;
  SmallVehicle vehicle;
  planner::Planner planner;
  planner::Senses senses;
  double period_s;
  std::int64_t ahead_ns = 0;  ///< Of the odometry's clock.
  int falls_back_each = 0;    ///< In each such cycle a pose is so much older:
  std::int64_t falls_back_ns = 23'000'000;
  int cycles = 0;
};

}  // namespace gvom::test
