// The trail's landscape as nodes of a height map.
#pragma once

#include "tools/sim/scenes/trail_landscape.hpp"
#include "tools/sim/terrain.hpp"

namespace gvom::sim {

/// Covers at least `area`, at 0.1 m; heights are multiples of 1/4096 m, so that they are the same on every
/// machine.
GroundMap trail_ground(const Landscape& landscape, const Area& area);

}  // namespace gvom::sim
