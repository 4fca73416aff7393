// Counts the passes of rays (R5) in a dense grid of bricks, several voxels at a time, and how low they have
// been in each column (R5a).
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.hpp"
#include "core/lowest_ray.hpp"

namespace gvom::cpu {

/// Rays are cast in batches of at most this many.
inline constexpr int kRayBatch = 64;

/// Where the rays of a batch end.
struct RayEnds {
  int count = 0;
  std::int64_t to[3][kRayBatch];     ///< Fixed coordinates relative to the grid's origin (core/ray.hpp).
  std::uint32_t counter[kRayBatch];  ///< Of the end's voxel: PassCounters::index.
};

/// Pass counters of a whole grid, brick by brick, and which bricks have any. Index of a voxel's counter:
/// brick slot * 512 + cell. One more brick takes what falls outside of the grid.
class PassCounters {
 public:
  explicit PassCounters(const Grid& grid);

  /// Adds a pass to every voxel of the grid that the segments go through except each end's own voxel (R5).
  /// @param from fixed coordinates of where all of them start; within 2^22 voxels, like the ends
  /// @param ends at least one
  void cast(const std::int64_t (&from)[3], const RayEnds& ends);

  /// Index of a voxel's counter; `outside()` where the grid does not reach.
  [[nodiscard]] std::uint32_t index(std::int32_t x, std::int32_t y, std::int32_t z) const {
    if (!inside(x, y, z)) return outside();
    return (brick_slot(x >> 3, y >> 3, z >> 3, bricks_[0], bricks_[1]) << 9) | cell_in_brick(x, y, z);
  }
  [[nodiscard]] std::uint32_t outside() const {
    return static_cast<std::uint32_t>(counters_.size() - kBrickCells);
  }

  /// The same for a column of `lowest()`.
  [[nodiscard]] std::uint32_t column(std::int32_t x, std::int32_t y) const {
    return inside(x, y, 0) ? column_in_stacks(x, y, bricks_[0]) : outside_column();
  }
  [[nodiscard]] std::uint32_t outside_column() const {
    return static_cast<std::uint32_t>(lowest_.size() - 1);
  }

  std::uint32_t* counters() { return counters_.data(); }
  std::uint8_t* touched() { return touched_.data(); }
  /// Per column (`column_in_stacks`): the lowest height of a ray there (core/lowest_ray.hpp), or kNoRay.
  std::int32_t* lowest() { return lowest_.data(); }

 private:
  void cast_exactly(const std::int64_t (&from)[3], const std::int64_t (&to)[3]);
  void lower_to(std::uint32_t column, std::int32_t height) {
    if (height < lowest_[column]) lowest_[column] = height;
  }
  [[nodiscard]] bool inside(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return static_cast<std::uint32_t>(x) < static_cast<std::uint32_t>(size_[0]) &&
           static_cast<std::uint32_t>(y) < static_cast<std::uint32_t>(size_[1]) &&
           static_cast<std::uint32_t>(z) < static_cast<std::uint32_t>(size_[2]);
  }

  Int3 size_;
  Int3 bricks_;
  std::vector<std::uint32_t> counters_;
  std::vector<std::uint8_t> touched_;
  std::vector<std::int32_t> lowest_;
  // Of a batch: counters behind its crossings, columns that some of them leave, and the heights.
  std::vector<std::uint32_t> crossed_;
  std::vector<std::uint32_t> crossed_passes_;
  std::vector<std::uint32_t> crossed_column_;
  std::vector<std::int32_t> crossed_height_;
};

}  // namespace gvom::cpu
