// A vehicle with one lidar that sees points given in odom: for statements about what the map then says.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "core/brick_map_storage.hpp"
#include "core/mapper.hpp"
#include "tests/oracle/layers.hpp"
#include "tests/oracle/voxels.hpp"

namespace gvom::test {

using Points = std::vector<Eigen::Vector3d>;

/// 64 x 64 x 64 voxels of half a metre, the window alone: numbers that one can compute in one's head.
MapperConfig half_metre_map();

/// All layers of one column.
struct ColumnValues {
  float height, inferred_height, slope_x, slope_y, slope, roughness, obstacle_density, negative_delta,
      clearance, last_seen;
  std::uint8_t flags, visibility, cost;
};

/// The lidar sits in the middle of a voxel: 0.25 m ahead and to the left, 1.25 m above base_link.
inline const Eigen::Vector3d kSensor_m(0.25, 0.25, 1.25);

class Rig {
 public:
  explicit Rig(const MapperConfig& config = half_metre_map());

  /// A sweep that saw these points, the vehicle standing at `vehicle_m`, upright if it is not told.
  AddResult see(const Points& points_m, std::int64_t stamp_ns = 1'000'000'000,
                const Eigen::Vector3d& vehicle_m = Eigen::Vector3d::Zero(),
                const Eigen::Quaterniond& lean = Eigen::Quaterniond::Identity());

  /// Forgets all maps.
  void reset();

  /// The layers, made afresh, in the column that holds a place.
  ColumnValues column(double x_m, double y_m);
  /// The centres of the columns that carry a flag, [y][x] in order.
  std::vector<std::array<double, 2>> flagged(ColumnFlag flag);
  /// The fused voxel that holds a point.
  [[nodiscard]] oracle::Voxel voxel(double x_m, double y_m, double z_m) const;
  /// The lowest point of a ray (R5a) in the fused column that holds a place.
  [[nodiscard]] float lowest_ray_m(double x_m, double y_m) const;
  /// Sums over all fused voxels.
  [[nodiscard]] oracle::Voxel total() const;

  [[nodiscard]] const MapFuser& fuser() const { return fuser_; }
  [[nodiscard]] const FilterCounts& filter_counts() const { return mapper_.filter_counts(); }

 private:
  MapperConfig config_;
  SweepMapper mapper_;
  MapFuser fuser_;
  std::map<std::uint64_t, std::unique_ptr<BrickMapStorage>> kept_;  // by token
  std::uint64_t next_token_ = 0;
};

/// Points at the centres of all half-metre columns of a rectangle, one each; `z_m(x, y)` is their height.
template <class Height>
Points surface(double x_low_m, double x_high_m, double y_low_m, double y_high_m, Height&& z_m) {
  Points points;
  for (double y = y_low_m + 0.25; y < y_high_m; y += 0.5)
    for (double x = x_low_m + 0.25; x < x_high_m; x += 0.5) points.emplace_back(x, y, z_m(x, y));
  return points;
}

/// Level ground 5 cm above zero.
Points floor_points(double x_low_m, double x_high_m, double y_low_m, double y_high_m);

inline Points operator+(Points a, const Points& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace gvom::test
