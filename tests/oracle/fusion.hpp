// The fused map (R7, R8), summed afresh from every map that ever came.
#pragma once

#include <vector>

#include "tests/oracle/sweep.hpp"
#include "tests/oracle/voxels.hpp"

namespace gvom::oracle {

class Fusion {
 public:
  explicit Fusion(const WindowConfig& config) : config_(config) {}

  /// Whether the map is of the window. A second map of a lidar and a stamp is not.
  bool add(const BufferMap& map);

  /// The maps of R7, newest first; of maps with one stamp, the lower lidar first.
  [[nodiscard]] std::vector<const BufferMap*> window() const;

  /// Sums and minima of the window, in the grid of its newest map.
  [[nodiscard]] VoxelBox voxels() const;
  /// The lowest heights of rays in the window (R5a), likewise.
  [[nodiscard]] ColumnHeights lowest_ray() const;

 private:
  WindowConfig config_;
  std::vector<BufferMap> maps_;  // all that ever came
};

}  // namespace gvom::oracle
