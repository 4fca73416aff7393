// What a session reads and writes on the bus, as the simulation knows it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/format/layers.hpp"
#include "ipc/layers.hpp"
#include "ipc/messages.hpp"
#include "services/planner/planner.hpp"

namespace gvom::driving {

/// Without A*'s path, roll and pitch, which are not on the bus.
planner::Plan plan_of(const ipc::Plan& message);

/// At most Course::kMaxPlaces of them.
ipc::Course course_message(const std::vector<Eigen::Vector2d>& waypoints_m);

/// All layers; `out` is of the same size.
void copy(const ipc::LayersSample& layers, const LayerArrays& out);

}  // namespace gvom::driving
