// What stands on the ground and hangs over it (R11, R14), from the text of core/README.md alone.
#pragma once

#include "tests/oracle/ground.hpp"
#include "tests/oracle/layers.hpp"
#include "tests/oracle/left.hpp"
#include "tests/oracle/sight_line.hpp"

namespace gvom::oracle {

/// Writes `obstacle_density` and `clearance`, and adds HARD and SOFT to `flags`.
void find_obstacles(const FusedColumns& map, const Leaving& leaving, const Ground& ground,
                    const ColumnAt& vehicle, Layers& out);

}  // namespace gvom::oracle
