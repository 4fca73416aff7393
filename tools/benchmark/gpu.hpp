// The CUDA back end beside the CPU's: the same maps in the same order, and the same bytes required.
#pragma once

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/cuda/open.hpp"
#include "tools/benchmark/failure.hpp"
#include "tools/benchmark/measure.hpp"

namespace gvom::bench {

/// "256 x 256 x 64".
std::string name_of(const MapConfig& grid);

/// Ticks of one grid and window.
struct TickRow {
  MapConfig map;
  int window;
  TickTimes cpu;
  tl::expected<TickTimes, std::string> cuda;  ///< Error: it does not fit into the device's memory.
};

struct GpuComparison {
  cuda::CopyRates rates;
  MapConfig voxelized;  ///< The grid of the following.
  VoxelizingTimes cpu_voxelizing;
  VoxelizingTimes cuda_voxelizing;
  std::vector<TickRow> rows;
};

/// @param quick one small grid and window instead of all
/// Errors: `unavailable` if there is no usable GPU, in the driver's words; `internal` if the results differ.
tl::expected<GpuComparison, Failure> compare_with_gpu(const Recording& recording, int repeats, bool quick);

}  // namespace gvom::bench
