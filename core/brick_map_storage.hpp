// A buffer map in memory of its own, for where there is no shared memory to write into.
#pragma once

#include <vector>

#include "core/format/brick_map.hpp"
#include "core/pose.hpp"

namespace gvom {

class BrickMapStorage {
 public:
  /// Makes room for a map; what was there is lost.
  BrickMapArrays resize(const BrickMapShape& shape) {
    shape_ = shape;
    directory_.resize(shape.brick_slots);
    lookup_.resize(std::size_t{shape.brick_count} * kBrickCells);
    columns_.resize(shape.brick_count);
    lowest_ray_m_.resize(shape.column_count);
    records_.resize(shape.record_count);
    return {directory_.data(), lookup_.data(), columns_.data(), lowest_ray_m_.data(), records_.data()};
  }

  [[nodiscard]] BrickMapView view(const Grid& grid, std::int64_t stamp_ns, const Pose& T_odom_base) const {
    return {grid,           stamp_ns,        record_of(T_odom_base), shape_,         directory_.data(),
            lookup_.data(), columns_.data(), lowest_ray_m_.data(),   records_.data()};
  }

 private:
  BrickMapShape shape_;
  std::vector<std::int32_t> directory_;
  std::vector<std::int32_t> lookup_;
  std::vector<std::uint64_t> columns_;
  std::vector<float> lowest_ray_m_;
  std::vector<VoxelRecord> records_;
};

}  // namespace gvom
