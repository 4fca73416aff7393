#include "tests/oracle/layers.hpp"

#include <algorithm>
#include <cmath>

#include "tests/oracle/plane.hpp"

namespace gvom::oracle {

namespace {

constexpr std::int64_t kNever_ns = INT64_MIN;

// One column with the rules' words for its parts.
class ColumnWalk {
 public:
  ColumnWalk(const MapperConfig& config, const VoxelBox& voxels, int x, int y)
      : layers_(config.layers), voxels_(voxels), x_(x), y_(y) {}

  [[nodiscard]] int height() const { return voxels_.grid().size[2]; }
  [[nodiscard]] const Voxel& at(int z) const { return voxels_.local(x_, y_, z); }
  [[nodiscard]] bool occupied(int z) const { return at(z).hits >= static_cast<unsigned>(layers_.min_hits); }
  [[nodiscard]] bool free(int z) const { return at(z).observed() && !occupied(z); }

  [[nodiscard]] int lowest_occupied() const {
    for (int z = 0; z < height(); ++z)
      if (occupied(z)) return z;
    return -1;
  }
  [[nodiscard]] int lowest_free() const {
    for (int z = 0; z < height(); ++z)
      if (free(z)) return z;
    return -1;
  }

 private:
  const LayersConfig& layers_;
  const VoxelBox& voxels_;
  int x_, y_;
};

bool is_near_vehicle(const MapperConfig& config, const BufferMap& newest, int x, int y) {
  const double edge_m = config.map.resolution_xy_m;
  const double dx_m = (newest.grid.origin[0] + x + 0.5) * edge_m - newest.T_odom_base.translation_m.x();
  const double dy_m = (newest.grid.origin[1] + y + 0.5) * edge_m - newest.T_odom_base.translation_m.y();
  return std::sqrt(dx_m * dx_m + dy_m * dy_m) <= config.vehicle.radius_m;
}

// R11, R14.
void find_obstacles(const MapperConfig& config, const ColumnWalk& column, std::size_t i, Layers& out) {
  std::uint64_t hits = 0, rays = 0;
  for (int z = 0; z < column.height(); ++z) {
    if (!column.occupied(z)) continue;
    const double above_m = double{column.at(z).min_height_m} - double{out.height[i]};
    if (above_m > config.layers.max_obstacle_height_m && std::isinf(out.clearance[i]))
      out.clearance[i] = static_cast<float>(above_m);
    if (above_m < config.layers.min_obstacle_height_m || above_m > config.layers.max_obstacle_height_m)
      continue;
    hits += column.at(z).hits;
    rays += std::uint64_t{column.at(z).hits} + column.at(z).passes;
  }
  const double density = hits == 0 ? 0 : static_cast<double>(hits) / static_cast<double>(rays);
  out.obstacle_density[i] = static_cast<float>(density);
  if (density > 0) out.flags[i] |= density >= config.layers.density_threshold ? kHard : kSoft;
}

// R9, R10, R11, R14, R15 without `last_seen`.
void read_column(const MapperConfig& config, const BufferMap& newest, const ColumnWalk& column, int x, int y,
                 Layers& out) {
  const std::size_t i = out.index(x, y);
  const int ground = column.lowest_occupied(), free = column.lowest_free();
  const bool assumed = ground < 0 && is_near_vehicle(config, newest, x, y);
  out.flags[i] = assumed ? kAssumed : 0;
  out.visibility[i] = ground >= 0 ? 3 : assumed ? 2 : free >= 0 ? 1 : 0;
  out.inferred_height[i] =
      free < 0 ? NAN : static_cast<float>((newest.grid.origin[2] + free) * config.map.resolution_z_m);
  out.height[i] = NAN;
  out.obstacle_density[i] = NAN;
  out.clearance[i] = NAN;
  if (ground < 0 && !assumed) return;
  out.height[i] =
      ground >= 0 ? column.at(ground).min_height_m
                  : static_cast<float>(newest.T_odom_base.translation_m.z() - config.vehicle.base_height_m);
  out.clearance[i] = INFINITY;
  out.obstacle_density[i] = 0;
  if (ground >= 0) find_obstacles(config, column, i, out);
}

float height_at(const Layers& layers, int x, int y) {
  const bool inside = x >= 0 && y >= 0 && x < layers.n && y < layers.n;
  return inside ? layers.height[layers.index(x, y)] : NAN;
}

// R12.
void fit_plane(const MapperConfig& config, int x, int y, Layers& out) {
  const int reach = config.layers.plane_size / 2;
  std::vector<HeightAt> heights;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const float z_m = height_at(out, x + dx, y + dy);
      if (!std::isnan(z_m)) heights.push_back({dx, dy, double{z_m}});
    }
  const PlaneValues plane =
      plane_through(heights, config.map.resolution_xy_m, config.layers.slope_threshold_rad);
  const std::size_t i = out.index(x, y);
  out.slope_x[i] = plane.slope_x;
  out.slope_y[i] = plane.slope_y;
  out.slope[i] = plane.slope;
  out.roughness[i] = plane.roughness;
  if (plane.steep) out.flags[i] |= kSteep;
}

// Which rows and columns hold any height at all. The others the search steps over: where next to nothing is
// known it would look at each cell of the grid for each cell of the grid.
struct KnownLines {
  explicit KnownLines(const Layers& layers)
      : row(std::size_t(layers.n), false), column(std::size_t(layers.n), false) {
    for (std::size_t i = 0; i < layers.height.size(); ++i)
      if (!std::isnan(layers.height[i]))
        row[i / std::size_t(layers.n)] = column[i % std::size_t(layers.n)] = true;
  }

  std::vector<bool> row, column;
};

// The height that the search in the direction (dx, dy) finds, or NaN (R13).
float search(const MapperConfig& config, const Layers& layers, const KnownLines& known, int x, int y, int dx,
             int dy) {
  for (int i = 1; i <= config.layers.search_distance; ++i) {
    const int line = dx != 0 ? x + i * dx : y + i * dy;
    if (line < 0 || line >= layers.n) return NAN;
    if (!(dx != 0 ? known.column : known.row)[std::size_t(line)]) continue;
    for (int aside = 0; aside <= i; ++aside)
      for (const int offset : {-aside, aside}) {
        const float found =
            height_at(layers, x + i * dx + offset * std::abs(dy), y + i * dy + offset * std::abs(dx));
        if (!std::isnan(found)) return found;
      }
  }
  return NAN;
}

// R13.
void find_negative(const MapperConfig& config, const KnownLines& known, int x, int y, Layers& out) {
  const std::size_t i = out.index(x, y);
  out.negative_delta[i] = 0;
  if (!std::isnan(out.height[i]) || std::isnan(out.inferred_height[i])) return;
  std::vector<double> found;
  for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
    const float height = search(config, out, known, x, y, dx, dy);
    if (!std::isnan(height)) found.push_back(height);
  }
  if (found.empty()) return;
  const double highest = *std::max_element(found.begin(), found.end());
  found.push_back(out.inferred_height[i]);
  const double delta_m = highest - *std::min_element(found.begin(), found.end());
  out.negative_delta[i] = static_cast<float>(delta_m);
  if (delta_m > config.layers.negative_threshold_m) out.flags[i] |= kNegative;
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
  const VoxelBox voxels = fusion.voxels();
  const BufferMap& newest = *fusion.window().front();
  const std::vector<std::int64_t> newest_ns = newest_stamps(fusion);
  Layers out(config.map.size_xy);
  const auto each = [&](auto&& visit) {
    for (int y = 0; y < out.n; ++y)
      for (int x = 0; x < out.n; ++x) visit(x, y);
  };
  each([&](int x, int y) { read_column(config, newest, ColumnWalk(config, voxels, x, y), x, y, out); });
  each([&](int x, int y) {
    const std::size_t i = out.index(x, y);
    out.last_seen[i] = newest_ns[i] == kNever_ns
                           ? NAN
                           : static_cast<float>(static_cast<double>(newest.stamp_ns - newest_ns[i]) * 1e-9);
  });
  each([&](int x, int y) { fit_plane(config, x, y, out); });
  const KnownLines known(out);
  each([&](int x, int y) { find_negative(config, known, x, y, out); });
  each([&](int x, int y) { out.cost[out.index(x, y)] = cost(config.cost, out, out.index(x, y)); });
  return out;
}

}  // namespace gvom::oracle
