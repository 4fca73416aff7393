// The voxels on a ray (R5), from all its face crossings sorted by their exact fractions.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.hpp"

namespace gvom::oracle {

/// Voxels from that of `from` up to but without that of `to`, relative to the grid's origin.
/// @param from,to fixed coordinates as core/ray.hpp defines them
std::vector<Int3> voxels_before_end(const std::int64_t (&from)[3], const std::int64_t (&to)[3]);

}  // namespace gvom::oracle
