// The CPU and the CUDA back end side by side, through one segment of shared memory.
#pragma once

#include <cstdint>

#include "tests/core/scenario.hpp"

namespace gvom::test {

struct TwinTally {
  int added = 0;
  int layers = 0;
  int most_maps = 0;  ///< In the window.
  int most_left = 0;  ///< With one map.
};

/// Runs one random drive on both. Every buffer map, the layers after every few maps and the exported voxels
/// must be the same bytes, NaN included. A map's memory is spoilt as soon as it has left the window.
TwinTally run_twins(const ScenarioSize& size, std::uint64_t seed);
/// The same of a drive that the test made.
TwinTally run_scenario_twins(const Scenario& scenario, std::uint64_t seed);

}  // namespace gvom::test
