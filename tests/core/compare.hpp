// What two back ends disagree about, in words; empty where they agree to the bit.
#pragma once

#include <string>

#include "core/mapper.hpp"
#include "tests/oracle/fusion.hpp"
#include "tests/oracle/layers.hpp"

namespace gvom::test {

/// Holds a brick map against voxels and lowest rays, and to the one form that it may have: bricks in order of
/// slots, only such with an observed voxel, records in order of bricks and cells (R6). In the words of
/// tools/compare/maps.hpp, as the layers' below.
std::string difference(const BrickMapView& map, const oracle::VoxelBox& voxels,
                       const oracle::ColumnHeights& lowest_ray);

/// The same of a buffer map, with its grid and stamp.
std::string difference(const BrickMapView& map, const oracle::BufferMap& expected);

/// Voxels, masks of occupied and free (R8), last seen stamps and lowest rays (R5a) of the fused map.
std::string difference(const FusedView& map, const oracle::Fusion& expected, int min_hits);

/// All layers, to the bit; NaN is NaN.
std::string difference(oracle::Layers layers, oracle::Layers expected);

/// The fused map as it is exported, written to arrays of exactly the size asked for.
std::string export_difference(MapFuser& fuser, const oracle::Fusion& expected);

/// The map within a fuser that runs on the CPU; null in another.
const cpu::FusedMap* cpu_map(const MapFuser& fuser);

}  // namespace gvom::test
