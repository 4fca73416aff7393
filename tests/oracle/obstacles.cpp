#include "tests/oracle/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gvom::oracle {

namespace {

// Of a column's obstacle voxels, and of its low ones.
struct Sums {
  std::uint64_t hits = 0, rays = 0, voxels = 0, low_hits = 0;
};

class Obstacles {
 public:
  Obstacles(const FusedColumns& map, const Leaving& leaving, const Ground& ground, const ColumnAt& vehicle)
      : map_(map),
        leaving_(leaving),
        layers_(map.config.layers),
        ground_(ground),
        vehicle_(vehicle),
        sums_(ground.rim.n(), {}) {
    each_column(sums_.n(), [&](int x, int y) { sums_.set(x, y, sums_of(x, y)); });
  }

  [[nodiscard]] float density(int x, int y) const {
    const Sums own = sums_.at(x, y);
    return own.hits == 0 ? 0 : static_cast<float>(double(own.hits) / double(own.rays));
  }

  [[nodiscard]] float clearance_m(int x, int y) const {
    const ColumnVoxels column = map_.column(x, y);
    for (int z = 0; z < column.count(); ++z)
      if (column.occupied(z) && over_ground_m(x, y, z) > layers_.max_obstacle_height_m)
        return static_cast<float>(over_ground_m(x, y, z));
    return INFINITY;
  }

  [[nodiscard]] std::uint8_t flag(int x, int y) const {
    const Sums own = sums_.at(x, y), around = sums_around(x, y);
    if (around.low_hits >= 10 && own.low_hits > 0 && casts_high_shadow(x, y, around)) return kHard;
    if (around.low_hits >= 10 && casts_low_shadow(x, y)) return kHard;
    if (own.hits == 0) return 0;
    if (around.hits < 4) return kSoft;
    return is_dense(around) || (is_surely_thick(around) && is_tall(x, y)) ? kHard : kSoft;
  }

 private:
  [[nodiscard]] bool has_height(int x, int y) const { return ground_.height_m.at(x, y) < INFINITY; }

  [[nodiscard]] double over_ground_m(int x, int y, int z) const {
    return double{map_.column(x, y).at(z).min_height_m} - double{ground_.height_m.at(x, y)};
  }

  // R17, 6: remembered, over ground that the window has.
  [[nodiscard]] bool is_past(int x, int y, int z) const {
    return map_.column(x, y).at(z).remembered && !map_.remembers_ground(x, y);
  }

  // An occupied voxel from 0.1 m below an obstacle's height on, but up to the greatest.
  [[nodiscard]] bool is_at_height(int x, int y, int z) const {
    if (!map_.column(x, y).occupied(z) || is_past(x, y, z)) return false;
    const double over_m = over_ground_m(x, y, z);
    return over_m >= layers_.min_obstacle_height_m - 0.1 && over_m <= layers_.max_obstacle_height_m;
  }

  // R11: by what the rays say, or with the one below it.
  [[nodiscard]] bool was_left(int x, int y, int z) const {
    if (!is_at_height(x, y, z)) return false;
    const Int3& origin = map_.voxels.grid().origin;
    const Int3 world{origin[0] + x, origin[1] + y, origin[2] + z};
    if (leaving_.passed(world, map_.column(x, y).at(z))) return true;
    return leaving_.quiet(world) && was_left(x, y, z - 1);
  }

  [[nodiscard]] bool is_obstacle(int x, int y, int z) const {
    return is_at_height(x, y, z) && over_ground_m(x, y, z) >= layers_.min_obstacle_height_m &&
           !was_left(x, y, z);
  }

  [[nodiscard]] Sums sums_of(int x, int y) const {
    Sums sums;
    if (!has_height(x, y)) return sums;
    const ColumnVoxels column = map_.column(x, y);
    for (int z = 0; z < column.count(); ++z) {
      if (!is_at_height(x, y, z)) continue;
      const bool low = over_ground_m(x, y, z) < layers_.min_obstacle_height_m, left = was_left(x, y, z);
      if (!left) sums.low_hits += column.at(z).hits;
      if (low) continue;
      sums.rays += std::uint64_t{column.at(z).hits} + column.at(z).passes;
      if (left) continue;
      sums.hits += column.at(z).hits;
      sums.voxels += 1;
    }
    return sums;
  }

  [[nodiscard]] Sums sums_around(int x, int y) const {
    Sums total;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Sums one = sums_.at(x + dx, y + dy);
        total.hits += one.hits, total.rays += one.rays;
        total.voxels += one.voxels, total.low_hits += one.low_hits;
      }
    return total;
  }

  // How high over the ground of a column the lowest ray left another one.
  [[nodiscard]] double ray_over_m(const ColumnAt& column, const ColumnAt& at) const {
    const Columns<float>& rays_m =
        map_.remembers_ground(column.x, column.y) ? map_.lowest_ray_m : map_.window_ray_m;
    return double{rays_m.at(at.x, at.y)} - double{ground_.height_m.at(column.x, column.y)};
  }

  [[nodiscard]] bool four_behind(const SightLine& line) const {
    const ColumnAt last = line.at(-4);
    return line.length() > 0 && sums_.inside(last.x, last.y);
  }

  [[nodiscard]] bool casts_high_shadow(int x, int y, const Sums& around) const {
    const SightLine line({x, y}, vehicle_);
    if (!four_behind(line)) return false;
    int dark = 0;
    for (int behind = 1; behind <= 4; ++behind)
      if (ray_over_m({x, y}, line.at(-behind)) >= layers_.min_obstacle_height_m) ++dark;
    return dark >= 2 && (is_dark_at_once(x, y, line) || stopped(around) >= 0.25 * counted(around));
  }

  [[nodiscard]] bool is_dark_at_once(int x, int y, const SightLine& line) const {
    for (const int step : {0, -1})
      for (const ColumnAt& at : line.abreast(step))
        if (ray_over_m({x, y}, at) >= layers_.min_obstacle_height_m) return true;
    return false;
  }

  [[nodiscard]] bool casts_low_shadow(int x, int y) const {
    const SightLine line({x, y}, vehicle_);
    if (!four_behind(line)) return false;
    for (std::size_t side = 0; side < 3; ++side) {
      const double own_m = ray_over_m({x, y}, line.abreast(0)[side]);
      const double next_m = ray_over_m({x, y}, line.abreast(-1)[side]);
      const double end_m = ray_over_m({x, y}, line.abreast(-4)[side]);
      if (std::isinf(own_m) || std::isinf(next_m)) continue;
      const double top_m = std::max(own_m, next_m);
      if (top_m >= 0.7 * layers_.min_obstacle_height_m && end_m < top_m - 0.2) return true;
    }
    return false;
  }

  // Hits and rays, less a hit for each voxel.
  [[nodiscard]] static double stopped(const Sums& sums) { return double(sums.hits - sums.voxels); }
  [[nodiscard]] static double counted(const Sums& sums) { return double(sums.rays - sums.voxels); }

  [[nodiscard]] bool is_dense(const Sums& around) const {
    return counted(around) > 0 && stopped(around) >= layers_.density_threshold * counted(around);
  }

  // More hits than of dust, by 0.8 of the root of how many there are.
  [[nodiscard]] static bool is_surely_thick(const Sums& around) {
    const double over = stopped(around) - 0.05 * counted(around);
    return over > 0 && over * over >= 0.64 * stopped(around);
  }

  // The highest `min_height` of the layer z in the 3 x 3 columns; -infinity if it is empty.
  [[nodiscard]] double layer_m(int x, int y, int z) const {
    double highest_m = -INFINITY;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        if (!sums_.inside(x + dx, y + dy)) continue;
        const ColumnVoxels column = map_.column(x + dx, y + dy);
        if (column.occupied(z)) highest_m = std::max(highest_m, double{column.at(z).min_height_m});
      }
    return highest_m;
  }

  [[nodiscard]] bool is_tall(int x, int y) const {
    int z = 0;
    while (!is_obstacle(x, y, z)) ++z;
    double top_m = layer_m(x, y, z);
    for (int empty = 0; empty <= 1;) {
      const double next_m = layer_m(x, y, ++z);
      empty = std::isinf(next_m) ? empty + 1 : 0;
      if (empty == 0) top_m = next_m;
    }
    return top_m - double{ground_.height_m.at(x, y)} >=
           layers_.max_obstacle_height_m - map_.config.map.resolution_z_m;
  }

  const FusedColumns& map_;
  const Leaving& leaving_;
  const LayersConfig& layers_;
  const Ground& ground_;
  ColumnAt vehicle_;
  Columns<Sums> sums_;
};

}  // namespace

void find_obstacles(const FusedColumns& map, const Leaving& leaving, const Ground& ground,
                    const ColumnAt& vehicle, Layers& out) {
  const Obstacles obstacles(map, leaving, ground, vehicle);
  each_column(out.n, [&](int x, int y) {
    const std::size_t i = out.index(x, y);
    const bool known = ground.height_m.at(x, y) < INFINITY;
    out.obstacle_density[i] = known ? obstacles.density(x, y) : NAN;
    out.clearance[i] = known ? obstacles.clearance_m(x, y) : NAN;
    if (known) out.flags[i] |= obstacles.flag(x, y);
  });
}

}  // namespace gvom::oracle
