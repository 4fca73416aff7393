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
    const planner::State state = vehicle.state();
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
};

}  // namespace gvom::test
