// What is remembered of maps that left the window (R17), from the text of core/README.md alone: all of them
// are kept, and looked through afresh.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/config.hpp"
#include "tests/oracle/sweep.hpp"
#include "tests/oracle/voxels.hpp"

namespace gvom::oracle {

class Memory {
 public:
  explicit Memory(const MemoryConfig& config);

  [[nodiscard]] bool on() const { return beats_ > 0; }

  /// A map has come: the fused map's grid now, the newest stamp, and the maps that left.
  void step(const Grid& grid, std::int64_t newest_ns, const std::vector<BufferMap>& left);

  /// Fills the voxels that the window has not observed.
  void add_to(VoxelBox& voxels) const;
  /// The lowest heights of rays.
  [[nodiscard]] ColumnHeights lowest_ray() const;
  /// The newest beat of a map that observed the column, [y][x]; INT64_MIN: none.
  [[nodiscard]] std::vector<std::int64_t> column_beats() const;

 private:
  // A map that left at a step, with what it says.
  struct Gone {
    std::int64_t step;
    std::int64_t beat;
    BufferMap map;
    std::vector<WorldVoxel> telling;
  };

  [[nodiscard]] bool too_old(std::int64_t beat) const { return now_ - beat > beats_; }

  std::int64_t beats_;
  std::int64_t steps_ = 0;
  std::int64_t now_ = 0;
  Grid grid_;
  std::map<Int3, std::int64_t> bricks_;                 // of the grid: since which step
  std::map<std::pair<int, int>, std::int64_t> stacks_;  // likewise
  std::vector<Gone> gone_;
};

}  // namespace gvom::oracle
