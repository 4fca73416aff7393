// The fused map (R7, R8), summed afresh from every map that ever came, and what it remembers (R17).
#pragma once

#include <vector>

#include "tests/oracle/memory.hpp"
#include "tests/oracle/sweep.hpp"
#include "tests/oracle/voxels.hpp"

namespace gvom::oracle {

class Fusion {
 public:
  explicit Fusion(const WindowConfig& config, const MemoryConfig& memory = {})
      : config_(config), memory_(memory) {}

  /// Whether the map is of the window. A second map of a lidar and a stamp is not.
  bool add(const BufferMap& map);

  /// The maps of R7, newest first; of maps with one stamp, the lower lidar first.
  [[nodiscard]] std::vector<const BufferMap*> window() const;

  /// Sums and minima of the window, in the grid of its newest map.
  [[nodiscard]] VoxelBox voxels() const;
  /// The same, and what is remembered where the window has observed nothing.
  [[nodiscard]] VoxelBox shown_voxels() const;
  /// The lowest heights of rays in the window (R5a), likewise.
  [[nodiscard]] ColumnHeights lowest_ray() const;
  /// The same of what is remembered.
  [[nodiscard]] ColumnHeights remembered_ray() const;
  [[nodiscard]] const Memory& memory() const { return memory_; }

 private:
  WindowConfig config_;
  Memory memory_;
  std::vector<BufferMap> maps_;  // all that ever came
};

}  // namespace gvom::oracle
