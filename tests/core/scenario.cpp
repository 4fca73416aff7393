#include "tests/core/scenario.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "tests/core/random.hpp"
#include "tests/core/random_world.hpp"
#include "tests/oracle/sweep.hpp"

namespace gvom::test {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

MapperConfig random_config(Random& random, const ScenarioSize& size) {
  MapperConfig config;
  config.map.size_xy = size.size_xy;
  config.map.size_z = size.size_z;
  config.map.resolution_xy_m =
      size.on_faces ? random.pick({0.25, 0.5, 1.0, 0.4, 0.2}) : random.pick({0.4, 0.2, 0.13});
  config.map.resolution_z_m = random.chance(0.5)
                                  ? config.map.resolution_xy_m
                                  : (size.on_faces ? random.pick({0.5, 0.4}) : random.pick({0.1, 0.3}));
  config.window.buffer_size = random.integer(1, 6);
  config.window.max_age_s = random.pick({0.0, 0.25, 0.5, 2.0, 3600.0});
  config.memory.max_age_s = size.max_memory_s > 0 ? random.uniform(0.1, size.max_memory_s) : 0;
  config.vehicle.radius_m = random.pick({0.0, 1.0, 2.0});
  config.vehicle.base_height_m = random.pick({0.0, 0.3});
  if (random.chance(0.3)) config.vehicle.body = Box{{-1.0, -0.5, -0.5}, {1.5, 0.5, 1.0}};
  config.layers.min_hits = random.pick({1, 1, 2, 3});
  config.layers.min_obstacle_height_m = random.pick({0.0, 0.25, 0.5});
  config.layers.max_obstacle_height_m = random.pick({0.5, 1.0, 2.0});
  config.layers.density_threshold = random.pick({0.1, 0.5, 1.0});
  config.layers.plane_size = random.pick({3, 3, 5, 7, 15});
  config.layers.slope_threshold_rad = random.pick({0.2, 0.5, 1.2});
  config.layers.search_distance = random.pick({1, 3, 8, 20, 20, 255});
  config.layers.negative_threshold_m = random.pick({0.0, 0.5});
  config.cost.soft_weight = random.pick({0.0, 1.0, 0.3});
  config.cost.slope_full_rad = random.pick({0.5, 1.1});
  return config;
}

// Half a voxel's edges, of which everything is a multiple where a scenario is on faces.
Eigen::Vector3d half_voxel_m(const MapConfig& map) {
  return {map.resolution_xy_m / 2, map.resolution_xy_m / 2, map.resolution_z_m / 2};
}

Eigen::Vector3d half_voxels(Random& random, const MapConfig& map, int most) {
  const Eigen::Vector3d steps(random.integer(-most, most), random.integer(-most, most),
                              random.integer(-most, most));
  return steps.cwiseProduct(half_voxel_m(map));
}

Eigen::Quaterniond random_rotation(Random& random, double most_rad) {
  const Eigen::Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1) + 1e-3);
  return Eigen::Quaterniond(Eigen::AngleAxisd(random.uniform(-most_rad, most_rad), axis.normalized()));
}

LidarGeometry random_lidar(Random& random, const MapConfig& map, bool on_faces) {
  LidarGeometry lidar;
  lidar.min_range_m = random.pick({0.0, 0.3});
  lidar.max_range_m = random.pick({20.0, 100.0, 1000.0});
  if (on_faces) {
    if (random.chance(0.5)) lidar.T_base_sensor.translation() = half_voxels(random, map, 6);
    return lidar;
  }
  lidar.T_base_sensor = random_rotation(random, 0.5);
  lidar.T_base_sensor.translation() << random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0, 2);
  return lidar;
}

// A drive near a home, from which the vehicle is taken away by more than the grid's own size, and back.
std::vector<StampedPose> random_drive(Random& random, const MapConfig& map, const ScenarioSize& size) {
  const Eigen::Vector3d extent_m(map.size_xy * map.resolution_xy_m, map.size_xy * map.resolution_xy_m,
                                 map.size_z * map.resolution_z_m);
  Eigen::Vector3d home_m = Eigen::Vector3d::Zero(), away_m = Eigen::Vector3d::Zero();
  if (random.chance(0.7))
    home_m = size.on_faces ? half_voxels(random, map, 400) : half_voxels(random, map, 40000);
  if (!size.on_faces && random.chance(0.2))
    home_m += Eigen::Vector3d(4e5, 5.2e6, 300);  // as a map projection has it
  std::vector<StampedPose> drive;
  for (int i = 0; i <= size.sweeps; ++i) {
    const double roll = random.uniform(0, 1);
    if (roll < 0.4)
      home_m += half_voxels(random, map, 6);
    else if (roll < 0.5)
      home_m += half_voxels(random, map, size.size_z);
    else if (roll < 0.52 && !size.on_faces)
      away_m.y() = away_m.y() != 0 ? 0 : -5.2e6;
    else if (roll < 0.65)
      for (int a = 0; a < 3; ++a)
        away_m[a] = away_m[a] != 0 ? 0 : extent_m[a] * random.pick({0.0, 0.5, 1.0, 2.5, -0.5, -1.0, -2.0});
    StampedPose pose{i * size.tick_ns, {home_m + away_m, Eigen::Quaterniond::Identity()}};
    if (!size.on_faces) {
      pose.T_odom_base.translation_m +=
          Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) * 0.3;
      pose.T_odom_base.rotation = random_rotation(random, random.pick({0.1, 3.0}));
    }
    drive.push_back(pose);
  }
  return drive;
}

// A drive over the ground of a world, from which the vehicle is now and then elsewhere at once.
std::vector<StampedPose> drive_over(Random& random, const RandomWorld& world, const MapConfig& map,
                                    const ScenarioSize& size) {
  double x_m = random.uniform(-100, 100), y_m = random.uniform(-100, 100);
  std::vector<StampedPose> drive;
  for (int i = 0; i <= size.sweeps; ++i) {
    const double step_m = (random.chance(0.1) ? map.size_xy : 3) * map.resolution_xy_m;
    x_m += random.uniform(-step_m, step_m);
    y_m += random.uniform(-step_m, step_m);
    const Eigen::Vector3d at_m(x_m, y_m, world.ground_m(x_m, y_m) + 0.3);
    drive.push_back({i * size.tick_ns, {at_m, random_rotation(random, 0.1)}});
  }
  return drive;
}

Return return_at(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z(), 0};
}

Return random_return(Random& random, const MapConfig& map, bool on_faces) {
  const double reach_m = map.size_xy * map.resolution_xy_m * 0.6;
  Eigen::Vector3d p(random.uniform(-reach_m, reach_m), random.uniform(-reach_m, reach_m),
                    random.uniform(-1.5, -1));
  const int kind = random.integer(0, 99);
  if (kind < 50 && !on_faces) return return_at(p);  // ground
  if (kind < 60) return return_at(half_voxels(random, map, map.size_xy));
  if (kind < 64)
    return return_at(half_voxel_m(map) * random.integer(-map.size_xy, map.size_xy));  // a diagonal
  if (kind < 70)
    return return_at(Eigen::Vector3d::Unit(random.integer(0, 2)) * random.uniform(-reach_m, reach_m));
  if (kind < 74) return return_at(half_voxels(random, map, 1));
  if (kind < 76) return return_at(Eigen::Vector3d::Zero());
  if (kind < 77) return return_at(p * (900 / p.norm()));
  if (kind < 80) {
    p[random.integer(0, 2)] = random.pick({kNan, -kNan, 1 / 0.0, -1 / 0.0});
    return return_at(p);
  }
  if (on_faces) return return_at(half_voxels(random, map, map.size_z));
  p.z() = random.uniform(-2, 4);  // something that stands
  return return_at(p);
}

Sweep random_sweep(Random& random, const MapConfig& map, const ScenarioSize& size, std::int64_t stamp_ns) {
  Sweep sweep;
  sweep.stamp_ns = stamp_ns;
  const int times = size.on_faces ? 1 : random.integer(1, 5);
  for (int i = 0; i < times; ++i) sweep.times_ns.push_back(stamp_ns - (times - 1 - i) * size.tick_ns / 7);
  const int returns = random.chance(0.05) ? 0 : size.returns;
  for (int i = 0; i < returns; ++i) {
    sweep.returns.push_back(random_return(random, map, size.on_faces));
    sweep.returns.back().time_index =
        static_cast<std::uint32_t>(random.chance(0.05) ? random.integer(0, times - 1) : i * times / returns);
  }
  return sweep;
}

// Makes all returns ones of points of a world.
void look_at(Random& random, const RandomWorld& world, const Scenario& scenario, const LidarGeometry& lidar,
             Sweep& sweep) {
  for (Return& r : sweep.returns) {
    const auto pose = oracle::pose_at(scenario.odometry, sweep.times_ns[r.time_index]);
    if (!pose) continue;
    const Eigen::Vector3d p_odom = world.point(random, pose->translation_m);
    const Eigen::Vector3d p_base = pose->rotation.inverse() * (p_odom - pose->translation_m);
    const Eigen::Vector3d p = lidar.T_base_sensor.inverse() * p_base;
    r = {p.x(), p.y(), p.z(), r.time_index};
  }
}

// Delays some, repeats some.
std::vector<Arrival> disorder(Random& random, const std::vector<Arrival>& in_order) {
  std::vector<std::pair<double, const Arrival*>> keyed;
  for (std::size_t i = 0; i < in_order.size(); ++i) {
    const double place = static_cast<double>(i);
    keyed.emplace_back(place + (random.chance(0.2) ? random.uniform(0, 12) : 0), &in_order[i]);
    if (random.chance(0.07)) keyed.emplace_back(place + random.uniform(0, 5), &in_order[i]);
  }
  std::stable_sort(keyed.begin(), keyed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Arrival> arrivals;
  for (const auto& [key, arrival] : keyed) arrivals.push_back(*arrival);
  return arrivals;
}

}  // namespace

Scenario random_scenario(std::uint64_t seed, const ScenarioSize& size) {
  Random random(seed);
  Scenario scenario;
  scenario.config = random_config(random, size);
  const MapConfig& map = scenario.config.map;
  std::optional<RandomWorld> world;
  if (!size.on_faces && random.chance(0.6)) world.emplace(random, map);
  scenario.odometry = world ? drive_over(random, *world, map, size) : random_drive(random, map, size);
  const int lidars = random.integer(1, 3);
  std::vector<Arrival> arrivals;
  for (int lidar = 0; lidar < lidars; ++lidar) {
    scenario.lidars.push_back(random_lidar(random, map, size.on_faces));
    const std::int64_t period_ns = size.tick_ns * random.integer(1, 3);
    const std::int64_t offset_ns =
        size.on_faces || random.chance(0.5) ? 0 : random.integer(1, 99) * 1'000'000;
    for (std::int64_t t = offset_ns; t <= (size.sweeps + 2) * size.tick_ns; t += period_ns) {
      arrivals.push_back({lidar, random_sweep(random, map, size, t)});
      if (world) look_at(random, *world, scenario, scenario.lidars.back(), arrivals.back().sweep);
    }
  }
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const Arrival& a, const Arrival& b) { return a.sweep.stamp_ns < b.sweep.stamp_ns; });
  scenario.arrivals = disorder(random, arrivals);
  return scenario;
}

}  // namespace gvom::test
