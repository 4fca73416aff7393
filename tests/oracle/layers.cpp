#include "tests/oracle/layers.hpp"

#include <algorithm>
#include <cmath>

#include "tests/oracle/columns.hpp"
#include "tests/oracle/ground.hpp"
#include "tests/oracle/holes.hpp"
#include "tests/oracle/obstacles.hpp"
#include "tests/oracle/plane.hpp"
#include "tests/oracle/sight_line.hpp"

namespace gvom::oracle {

namespace {

constexpr std::int64_t kNever_ns = INT64_MIN;
constexpr std::int64_t kBeat_ns = 1 << 29;  // of the memory

// R10, R15, and what R9 found.
void write_ground(const FusedColumns& map, const Ground& ground, bool of_window, int x, int y, Layers& out) {
  const std::size_t i = out.index(x, y);
  const ColumnVoxels column = map.column(x, y);
  const bool solid = map.ground(x, y) >= 0;
  const bool assumed = ground.assumed.at(x, y) == YesNo::yes;
  const bool known = ground.height_m.at(x, y) < INFINITY;
  const int free = column.lowest(&ColumnVoxels::free);
  out.height[i] = known ? ground.height_m.at(x, y) : NAN;
  out.inferred_height[i] =
      free < 0 ? NAN : static_cast<float>((map.newest.grid.origin[2] + free) * map.config.map.resolution_z_m);
  out.flags[i] = assumed ? kAssumed : 0;
  const bool remembered = solid ? map.remembers_ground(x, y) : free >= 0 && !of_window;
  out.visibility[i] = assumed ? 2 : remembered ? 4 : solid && known ? 3 : solid || free >= 0 ? 1 : 0;
}

// R12.
void fit_plane(const MapperConfig& config, const Ground& ground, int x, int y, Layers& out) {
  const int reach = config.layers.plane_size / 2;
  std::vector<HeightAt> heights;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx)
      if (ground.known_m.at(x + dx, y + dy) < INFINITY && ground.height_m.at(x + dx, y + dy) < INFINITY)
        heights.push_back({dx, dy, double{ground.height_m.at(x + dx, y + dy)},
                           out.visibility[out.index(x + dx, y + dy)] == 4});
  const PlaneValues plane =
      plane_through(heights, config.map.resolution_xy_m, config.layers.slope_threshold_rad);
  const std::size_t i = out.index(x, y);
  out.slope_x[i] = plane.slope_x;
  out.slope_y[i] = plane.slope_y;
  out.slope[i] = plane.slope;
  out.roughness[i] = plane.roughness;
  if (plane.steep) out.flags[i] |= kSteep;
}

// R15.
void write_last_seen(const FusedColumns& map, const Fusion& fusion, Layers& out) {
  const std::vector<std::int64_t> newest_ns = newest_stamps(fusion);
  const std::vector<std::int64_t> beats = fusion.memory().column_beats();  // empty where it is off
  const auto since = [&](std::int64_t stamp_ns) {
    return static_cast<float>(static_cast<double>(map.newest.stamp_ns - stamp_ns) * 1e-9);
  };
  each_column(out.n, [&](int x, int y) {
    const std::size_t i = out.index(x, y);
    const ColumnVoxels column = map.column(x, y);
    const bool free = column.lowest(&ColumnVoxels::free) >= 0;
    out.last_seen[i] = NAN;
    if (map.remembers_ground(x, y))
      out.last_seen[i] = since(column.at(map.ground(x, y)).beat * kBeat_ns);
    else if (newest_ns[i] != kNever_ns)
      out.last_seen[i] = since(newest_ns[i]);
    else if (free || map.ground(x, y) >= 0)
      out.last_seen[i] = since(beats[i] * kBeat_ns);
  });
}

ColumnAt vehicle_column(const BufferMap& newest) {
  const auto along = [&](std::size_t axis, double m) {
    return static_cast<int>(std::floor(m / newest.grid.resolution_m[axis])) - newest.grid.origin[axis];
  };
  const Eigen::Vector3d& vehicle_m = newest.T_odom_base.translation_m;
  return {along(0, vehicle_m.x()), along(1, vehicle_m.y())};
}

// The rays that columns are judged by: of the window, and with what is remembered (R17).
void find_rays(const Fusion& fusion, const FusedColumns& map, Columns<float>& window_m,
               Columns<float>& all_m) {
  ColumnHeights of_window = fusion.lowest_ray(), remembered = fusion.remembered_ray();
  const ColumnAt vehicle = vehicle_column(map.newest);
  each_column(all_m.n(), [&](int x, int y) { window_m.set(x, y, *of_window.at(x, y)); });
  each_column(all_m.n(), [&](int x, int y) {
    const double edge_m = map.config.map.resolution_xy_m;
    const int dx = x - vehicle.x, dy = y - vehicle.y;
    const bool far = edge_m * edge_m * (dx * dx + dy * dy) > 64;
    const bool seen_through = map.ground(x, y) < 0 && window_m.at(x, y) < INFINITY;
    const bool seen_ground = map.ground(x, y) >= 0 && !map.remembers_ground(x, y);
    const bool alone = seen_ground || (seen_through && far);
    all_m.set(x, y, alone ? window_m.at(x, y) : std::min(window_m.at(x, y), *remembered.at(x, y)));
  });
}

// R16.
std::uint8_t cost(const CostConfig& c, const Layers& layers, std::size_t i) {
  if ((layers.flags[i] & (kHard | kNegative | kSteep)) != 0) return 254;
  if (std::isnan(layers.height[i])) return 255;
  const double slope = std::isnan(layers.slope[i]) ? 0 : layers.slope[i];
  const double roughness = std::isnan(layers.roughness[i]) ? 0 : layers.roughness[i];
  const double sum = c.soft_weight * double{layers.obstacle_density[i]} +
                     c.slope_weight * std::min(1.0, slope / c.slope_full_rad) +
                     c.roughness_weight * std::min(1.0, roughness / c.roughness_full_m2);
  const double weights = c.soft_weight + c.slope_weight + c.roughness_weight;
  return static_cast<std::uint8_t>(std::floor(252 * std::min(1.0, sum / weights)));
}

}  // namespace

Layers::Layers(int size_xy) : n(size_xy) {
  const std::size_t columns = std::size_t(n) * std::size_t(n);
  for (auto* layer : {&height, &inferred_height, &slope_x, &slope_y, &slope, &roughness, &obstacle_density,
                      &negative_delta, &clearance, &last_seen})
    layer->assign(columns, -12345.0f);
  for (auto* layer : {&flags, &visibility, &cost}) layer->assign(columns, 0xA5);
}

LayerArrays Layers::arrays() {
  return {height.data(),
          inferred_height.data(),
          slope_x.data(),
          slope_y.data(),
          slope.data(),
          roughness.data(),
          obstacle_density.data(),
          negative_delta.data(),
          clearance.data(),
          last_seen.data(),
          flags.data(),
          visibility.data(),
          cost.data()};
}

std::vector<std::int64_t> newest_stamps(const Fusion& fusion) {
  const std::vector<const BufferMap*> window = fusion.window();
  const VoxelBox box(window.front()->grid);
  const Grid& grid = box.grid();
  std::vector<std::int64_t> newest_ns(std::size_t(grid.size[0]) * std::size_t(grid.size[1]), kNever_ns);
  for (const BufferMap* map : window)
    for (const WorldVoxel& one : map->observed) {
      if (!box.holds(one.at)) continue;
      std::int64_t& stamp_ns = newest_ns[std::size_t(one.at[1] - grid.origin[1]) * std::size_t(grid.size[0]) +
                                         std::size_t(one.at[0] - grid.origin[0])];
      stamp_ns = std::max(stamp_ns, map->stamp_ns);
    }
  return newest_ns;
}

Layers make_layers(const MapperConfig& config, const Fusion& fusion) {
  const VoxelBox voxels = fusion.shown_voxels();
  const BufferMap& newest = *fusion.window().front();
  Layers out(config.map.size_xy);
  Columns<float> lowest_ray_m(out.n, INFINITY), window_ray_m(out.n, INFINITY);
  const FusedColumns map{config, voxels, newest, lowest_ray_m, window_ray_m};
  find_rays(fusion, map, window_ray_m, lowest_ray_m);
  const Ground ground = find_ground(map);
  const std::vector<std::int64_t> newest_ns = newest_stamps(fusion);
  each_column(out.n, [&](int x, int y) {
    write_ground(map, ground, newest_ns[out.index(x, y)] != kNever_ns, x, y, out);
  });
  write_last_seen(map, fusion, out);
  const ColumnAt vehicle = vehicle_column(newest);
  find_obstacles(map, Leaving(fusion), ground, vehicle, out);
  each_column(out.n, [&](int x, int y) { fit_plane(config, ground, x, y, out); });
  find_holes(map, ground, vehicle, out);
  each_column(out.n,
              [&](int x, int y) { out.cost[out.index(x, y)] = cost(config.cost, out, out.index(x, y)); });
  return out;
}

}  // namespace gvom::oracle
