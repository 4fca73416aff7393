// The voxels on a ray (R5) and how it leaves columns (R5a), from all its face crossings sorted by their exact
// fractions.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.hpp"

namespace gvom::oracle {

/// Voxels from that of `from` up to but without that of `to`, relative to the grid's origin.
/// @param from,to fixed coordinates as core/ray.hpp defines them
std::vector<Int3> voxels_before_end(const std::int64_t (&from)[3], const std::int64_t (&to)[3]);

/// A ray's way out of a column, over an x or a y face.
struct Departure {
  Int3 from;            ///< The last voxel in the column.
  Int3 to;              ///< The first one behind the face.
  std::int64_t height;  ///< Of the ray there, 1 / 65536 voxels above the grid's origin.
};

/// All of a ray's, first to last.
std::vector<Departure> departures(const std::int64_t (&from)[3], const std::int64_t (&to)[3]);

}  // namespace gvom::oracle
