#include "tests/oracle/sweep.hpp"

#include <algorithm>
#include <cmath>

#include "core/ray.hpp"
#include "tests/oracle/ray.hpp"

namespace gvom::oracle {

namespace {

Grid grid_at(const MapConfig& map, const Eigen::Vector3d& vehicle_m) {
  Grid grid;
  grid.size = {map.size_xy, map.size_xy, map.size_z};
  grid.resolution_m = {map.resolution_xy_m, map.resolution_xy_m, map.resolution_z_m};
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    const double lowest = std::floor(vehicle_m[a] / grid.resolution_m[i]) - grid.size[i] / 2;
    grid.origin[i] = static_cast<std::int32_t>(8 * std::floor(lowest / 8));
  }
  return grid;
}

// The reason for which a return is dropped, if any (R2).
std::uint64_t* reason_to_drop(const Return& r, const LidarGeometry& lidar, const VehicleGeometry& vehicle,
                              FilterCounts& counts) {
  if (!std::isfinite(r.x_m) || !std::isfinite(r.y_m) || !std::isfinite(r.z_m)) return &counts.not_finite;
  const double range_m = std::sqrt(r.x_m * r.x_m + r.y_m * r.y_m + r.z_m * r.z_m);
  if (range_m < lidar.min_range_m) return &counts.too_near;
  if (range_m > lidar.max_range_m) return &counts.too_far;
  if (!vehicle.body) return nullptr;
  const Eigen::Vector3d p_base = lidar.T_base_sensor * Eigen::Vector3d(r.x_m, r.y_m, r.z_m);
  for (int a = 0; a < 3; ++a)
    if (p_base[a] < vehicle.body->min_m[a] || p_base[a] > vehicle.body->max_m[a]) return nullptr;
  return &counts.body;
}

// A ray in odom; the products and sums are in the order of the rows' elements.
struct OdomRay {
  double sensor_m[3];
  double return_m[3];

  OdomRay(const Pose& T_odom_base, const Eigen::Isometry3d& T_base_sensor, const Return& r) {
    const Eigen::Matrix3d R_odom_base = T_odom_base.rotation.toRotationMatrix();
    const Eigen::Matrix3d R = R_odom_base * T_base_sensor.linear();
    const Eigen::Vector3d t = R_odom_base * T_base_sensor.translation() + T_odom_base.translation_m;
    for (int a = 0; a < 3; ++a) {
      sensor_m[a] = t[a];
      return_m[a] = R(a, 0) * r.x_m + R(a, 1) * r.y_m + R(a, 2) * r.z_m + t[a];
    }
  }
};

// R5a.
void lower_columns(const std::int64_t (&from)[3], const std::int64_t (&to)[3], const VoxelBox& box,
                   ColumnHeights& lowest) {
  const Grid& grid = box.grid();
  for (const Departure& left : departures(from, to)) {
    const Int3 behind{grid.origin[0] + left.to[0], grid.origin[1] + left.to[1], grid.origin[2] + left.to[2]};
    float* const lowest_m = lowest.at(left.from[0], left.from[1]);
    if (lowest_m == nullptr || !box.holds(behind)) continue;
    const double voxels = grid.origin[2] + static_cast<double>(left.height) / 65536;
    const auto height_m = static_cast<float>(voxels * grid.resolution_m[2]);
    if (height_m < *lowest_m) *lowest_m = height_m == 0 ? 0.0f : height_m;
  }
}

void add_ray(const OdomRay& ray, VoxelBox& box, ColumnHeights& lowest) {
  const Grid& grid = box.grid();
  std::int64_t from[3], to[3];
  Int3 end;
  for (std::size_t a = 0; a < 3; ++a) {
    from[a] = to_fixed(ray.sensor_m[a] / grid.resolution_m[a], grid.origin[a]);
    to[a] = to_fixed(ray.return_m[a] / grid.resolution_m[a], grid.origin[a]);
    end[a] = static_cast<std::int32_t>(std::floor(ray.return_m[a] / grid.resolution_m[a]));
  }
  for (const Int3& local : voxels_before_end(from, to)) {
    const Int3 world{grid.origin[0] + local[0], grid.origin[1] + local[1], grid.origin[2] + local[2]};
    if (box.holds(world)) ++box[world].passes;
  }
  lower_columns(from, to, box, lowest);
  if (!box.holds(end)) return;
  Voxel& voxel = box[end];
  const auto height_m = static_cast<float>(ray.return_m[2]);
  ++voxel.hits;
  if (height_m < voxel.min_height_m) voxel.min_height_m = height_m == 0 ? 0.0f : height_m;
}

std::vector<WorldVoxel> observed_voxels(const VoxelBox& box) {
  const Grid& grid = box.grid();
  std::vector<WorldVoxel> observed;
  for (int y = 0; y < grid.size[1]; ++y)
    for (int x = 0; x < grid.size[0]; ++x)
      for (int z = 0; z < grid.size[2]; ++z)
        if (box.local(x, y, z).observed())
          observed.push_back(
              {{grid.origin[0] + x, grid.origin[1] + y, grid.origin[2] + z}, box.local(x, y, z)});
  return observed;
}

}  // namespace

std::optional<Pose> pose_at(const std::vector<StampedPose>& odometry, std::int64_t time_ns) {
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    const StampedPose& after = odometry[i];
    const Eigen::Quaterniond rotation = after.T_odom_base.rotation.normalized();
    if (after.stamp_ns == time_ns) return Pose{after.T_odom_base.translation_m, rotation};
    if (after.stamp_ns < time_ns) continue;
    if (i == 0) return std::nullopt;
    const StampedPose& before = odometry[i - 1];
    const double share = static_cast<double>(time_ns - before.stamp_ns) /
                         static_cast<double>(after.stamp_ns - before.stamp_ns);
    const Eigen::Vector3d a = before.T_odom_base.translation_m, b = after.T_odom_base.translation_m;
    return Pose{a + share * (b - a), before.T_odom_base.rotation.normalized().slerp(share, rotation)};
  }
  return std::nullopt;
}

std::optional<BufferMap> map_sweep(const MapperConfig& config, const LidarGeometry& lidar, const Sweep& sweep,
                                   const std::vector<StampedPose>& odometry) {
  const std::optional<Pose> at_stamp = pose_at(odometry, sweep.stamp_ns);
  if (!at_stamp) return std::nullopt;
  std::vector<std::optional<Pose>> poses;
  for (const std::int64_t time_ns : sweep.times_ns) poses.push_back(pose_at(odometry, time_ns));
  for (const Return& r : sweep.returns)
    if (!poses[r.time_index]) return std::nullopt;
  BufferMap map;
  map.stamp_ns = sweep.stamp_ns;
  map.T_odom_base = *at_stamp;
  map.grid = grid_at(config.map, at_stamp->translation_m);
  VoxelBox box(map.grid);
  map.lowest_ray = ColumnHeights(map.grid);
  for (const Return& r : sweep.returns) {
    std::uint64_t* dropped = reason_to_drop(r, lidar, config.vehicle, map.filter);
    ++(dropped != nullptr ? *dropped : map.filter.used);
    if (dropped == nullptr)
      add_ray(OdomRay(*poses[r.time_index], lidar.T_base_sensor, r), box, map.lowest_ray);
  }
  map.observed = observed_voxels(box);
  return map;
}

}  // namespace gvom::oracle
