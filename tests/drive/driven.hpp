// Vehicles that are driven straight ahead in small worlds.
#pragma once

#include <optional>
#include <utility>

#include "tests/tools/sim_worlds.hpp"
#include "tools/drive/mishap.hpp"

namespace gvom::test {

/// 1.6 x 1.4 x 1.8 m, wheels 1 m and 1.1 m apart, a clearance of 0.25 m, base_link in its middle.
inline driving::VehicleModel small_vehicle(planner::Steering steering = planner::Steering::ackermann) {
  driving::VehicleModel model;
  model.limits.steering = steering;
  model.limits.max_speed_mps = 10;
  return model;
}

/// Gives the same command for `seconds`, as often as a planner does.
inline void drive(driving::Vehicle& vehicle, const planner::Command& command, double seconds) {
  const int steps = static_cast<int>(seconds * driving::kSteps_hz + 0.5);
  for (int i = 0; i < steps; ++i) {
    if (i % 10 == 0) vehicle.command(vehicle.time_s(), command);
    vehicle.step();
  }
}

struct Driven {
  std::optional<driving::Mishap> mishap;
  planner::Pose2 place;
  int bushes = 0;
  int grass = 0;
};

/// Straight on at `speed_mps`, after a stand, until something happens.
inline Driven drive_on(const sim::World& world, const planner::Pose2& start, double speed_mps, double seconds,
                       double sets_off_s = 0) {
  driving::Vehicle vehicle(world.terrain(), small_vehicle(), start);
  driving::Watch watch(world, vehicle.model());
  Driven driven;
  while (!driven.mishap && vehicle.time_s() < seconds) {
    vehicle.command(vehicle.time_s(), {vehicle.time_s() < sets_off_s ? 0 : speed_mps, 0});
    vehicle.step();
    driven.mishap = watch.look(vehicle);
  }
  driven.place = vehicle.state().place;
  driven.bushes = watch.bushes_driven_through();
  driven.grass = watch.grass_driven_through();
  return driven;
}

/// Heights of the level world by a formula.
template <typename Formula>
sim::WorldData shaped_world(const Formula& height_m) {
  sim::WorldData data = level_world();
  sim::GroundMap& ground = data.ground;
  for (int iy = 0; iy < ground.nodes_y; ++iy)
    for (int ix = 0; ix < ground.nodes_x; ++ix)
      ground.height_m[static_cast<std::size_t>(iy) * ground.nodes_x + ix] = static_cast<float>(
          height_m(ground.min_x_m + ix * ground.resolution_m, ground.min_y_m + iy * ground.resolution_m));
  return data;
}

}  // namespace gvom::test
