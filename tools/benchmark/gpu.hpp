// The CUDA back end beside the CPU's: the same maps in the same order, and the same bytes required.
#pragma once

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "core/cuda/open.hpp"
#include "tools/benchmark/failure.hpp"
#include "tools/benchmark/measure.hpp"

namespace gvom::bench {

// Ticks, and sweeps, of a repeat: the CPU is there for its bytes and to be compared with, and slower. Kernels
// are timed by themselves in runs of their own.
inline constexpr int kDeviceRuns = 20;
inline constexpr int kHostRuns = 4;
inline constexpr int kKernelRuns = 4;

/// What of it is measured.
struct GpuSetting {
  int repeats = 20;
  int grids = 2;       ///< The first so many: 256 x 256 x 64, 512 x 512 x 128.
  bool quick = false;  ///< One small grid and window instead of all.
};

/// "256 x 256 x 64".
std::string name_of(const MapConfig& grid);

/// Ticks of one grid and window.
struct TickRow {
  MapConfig map;
  int window;
  TickTimes cpu;
  tl::expected<TickTimes, std::string> cuda;  ///< Error: it does not fit into the device's memory.

  /// In a tick, the mean of as many as there are.
  [[nodiscard]] double bricks_entering() const { return (cuda ? *cuda : cpu).bricks_entering; }
};

/// Each kernel of a sweep, or of a tick.
struct KernelTable {
  std::string of;  ///< Of what, for people.
  NamedSamples kernels;
};

struct GpuComparison {
  cuda::CopyRates rates;
  MapConfig voxelized;  ///< The grid of the following.
  VoxelizingTimes cpu_voxelizing;
  VoxelizingTimes cuda_voxelizing;
  std::vector<TickRow> rows;
  std::vector<KernelTable> kernels;
};

/// Errors: `unavailable` if there is no usable GPU, in the driver's words; `internal` if the results differ:
/// which arrays, where, by what.
tl::expected<GpuComparison, Failure> compare_with_gpu(const Recording& recording, const GpuSetting& setting);

}  // namespace gvom::bench
