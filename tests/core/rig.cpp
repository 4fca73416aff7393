#include "tests/core/rig.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "tests/core/compare.hpp"

namespace gvom::test {

namespace {

LidarGeometry rig_lidar() {
  LidarGeometry lidar;
  lidar.T_base_sensor.translation() = kSensor_m;
  lidar.min_range_m = 0;
  lidar.max_range_m = 1000;
  return lidar;
}

}  // namespace

MapperConfig half_metre_map() {
  MapperConfig config;
  config.map = {0.5, 0.5, 64, 64};
  config.memory.max_age_s = 0;
  return config;
}

Rig::Rig(const MapperConfig& config)
    : config_(config), mapper_(config, rig_lidar(), 100'000), fuser_(config) {}

AddResult Rig::see(const Points& points_m, std::int64_t stamp_ns, const Eigen::Vector3d& vehicle_m,
                   const Eigen::Quaterniond& lean) {
  OdometryBuffer odometry(1);
  odometry.add({stamp_ns, {vehicle_m, lean}});
  Sweep sweep;
  sweep.stamp_ns = stamp_ns;
  sweep.times_ns = {stamp_ns};
  for (const Eigen::Vector3d& point_m : points_m) {
    const Eigen::Vector3d p = lean.inverse() * (point_m - vehicle_m) - kSensor_m;
    sweep.returns.push_back({p.x(), p.y(), p.z(), 0});
  }
  auto storage = std::make_unique<BrickMapStorage>();
  const auto shape = mapper_.count(sweep, odometry);
  REQUIRE(shape);
  REQUIRE(mapper_.write(storage->resize(*shape)));
  const BrickMapView view = storage->view(mapper_.grid(), stamp_ns, mapper_.T_odom_base());
  const AddResult result = fuser_.add({view, 0, next_token_}).value();
  if (result != AddResult::added) return result;
  kept_[next_token_++] = std::move(storage);
  for (const WindowMap& left : fuser_.window().left()) kept_.erase(left.token);
  return result;
}

ColumnValues Rig::column(double x_m, double y_m) {
  oracle::Layers layers(config_.map.size_xy);
  REQUIRE(fuser_.make_layers(layers.arrays()));
  const Int3 origin = fuser_.moment().grid.origin;
  const std::size_t i =
      layers.index(static_cast<int>(std::floor(x_m / config_.map.resolution_xy_m)) - origin[0],
                   static_cast<int>(std::floor(y_m / config_.map.resolution_xy_m)) - origin[1]);
  return {layers.height[i],
          layers.inferred_height[i],
          layers.slope_x[i],
          layers.slope_y[i],
          layers.slope[i],
          layers.roughness[i],
          layers.obstacle_density[i],
          layers.negative_delta[i],
          layers.clearance[i],
          layers.last_seen[i],
          layers.flags[i],
          layers.visibility[i],
          layers.cost[i]};
}

std::vector<std::array<double, 2>> Rig::flagged(ColumnFlag flag) {
  oracle::Layers layers(config_.map.size_xy);
  REQUIRE(fuser_.make_layers(layers.arrays()));
  const Grid grid = fuser_.moment().grid;
  std::vector<std::array<double, 2>> centres_m;
  for (int y = 0; y < layers.n; ++y)
    for (int x = 0; x < layers.n; ++x)
      if ((layers.flags[layers.index(x, y)] & flag) != 0) {
        const auto centre_m = grid.center_m({grid.origin[0] + x, grid.origin[1] + y, 0});
        centres_m.push_back({centre_m[0], centre_m[1]});
      }
  return centres_m;
}

oracle::Voxel Rig::voxel(double x_m, double y_m, double z_m) const {
  const Grid grid = fuser_.moment().grid;
  const FusedView map = cpu_map(fuser_)->view();
  const auto local = [&](std::size_t axis, double m) {
    return static_cast<std::int32_t>(std::floor(m / grid.resolution_m[axis])) - grid.origin[axis];
  };
  const std::size_t cell = map.cell(local(0, x_m), local(1, y_m), local(2, z_m));
  return {map.hits[cell], map.passes[cell], map.min_height_m[cell]};
}

float Rig::lowest_ray_m(double x_m, double y_m) const {
  const Grid grid = fuser_.moment().grid;
  const FusedView map = cpu_map(fuser_)->view();
  const auto x = static_cast<std::int32_t>(std::floor(x_m / grid.resolution_m[0])) - grid.origin[0];
  const auto y = static_cast<std::int32_t>(std::floor(y_m / grid.resolution_m[1])) - grid.origin[1];
  return map.lowest_ray_m[map.stacked_column(x, y)];
}

void Rig::reset() {
  fuser_.reset();
  kept_.clear();
}

oracle::Voxel Rig::total() const {
  const FusedView map = cpu_map(fuser_)->view();
  const Int3 size = fuser_.moment().grid.size;
  oracle::Voxel sum;
  for (std::size_t i = 0; i < std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]); ++i) {
    sum.hits += map.hits[i];
    sum.passes += map.passes[i];
    if (map.hits[i] > 0) sum.min_height_m = std::min(sum.min_height_m, map.min_height_m[i]);
  }
  return sum;
}

Points floor_points(double x_low_m, double x_high_m, double y_low_m, double y_high_m) {
  return surface(x_low_m, x_high_m, y_low_m, y_high_m, [](double, double) { return 0.05; });
}

}  // namespace gvom::test
