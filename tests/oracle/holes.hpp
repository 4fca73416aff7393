// Holes: where a ray has been below the ground that should be there (R13), from the text of core/README.md
// alone.
#pragma once

#include "tests/oracle/ground.hpp"
#include "tests/oracle/layers.hpp"
#include "tests/oracle/sight_line.hpp"

namespace gvom::oracle {

/// Writes `negative_delta`, and adds NEGATIVE to `flags`.
void find_holes(const FusedColumns& map, const Ground& ground, const ColumnAt& vehicle, Layers& out);

}  // namespace gvom::oracle
