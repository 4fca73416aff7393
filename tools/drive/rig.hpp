// A vehicle with its lidars and what maps them.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/drive/vehicle_model.hpp"
#include "tools/mapping/pipeline.hpp"
#include "tools/sim/lidar_model.hpp"

namespace gvom::driving {

inline constexpr double kTurn_s = 0.1;  ///< Of an OS1 at 10 Hz: a step of the loop.

struct Rig {
  VehicleModel model;
  mapping::Vehicle mapping;
  sim::Sensor sensor = sim::Sensor::os1_64;  ///< Of all lidars: an OS1.
};

/// In the order of the rig's, without a name. A sweep ends with the loop's turn, or the lidar's own part of a
/// turn before: no two measure the same side at once. Number 0 turns with the loop.
std::vector<sim::LidarModel> make_lidars(const Rig& rig, std::uint64_t seed);

}  // namespace gvom::driving
