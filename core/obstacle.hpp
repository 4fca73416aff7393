// Obstacles above the ground (R11, R14), for host and device.
//
// What is tall is hard, and so is what is dense, or what no ray passes: behind a rock or a car no ray is low.
// The columns around a column say more of it than it alone: a trunk fills little of a voxel.
#pragma once

#include "core/column.hpp"
#include "core/column_bits.hpp"
#include "core/column_grid.hpp"
#include "core/left.hpp"
#include "core/sight_line.hpp"

namespace gvom {

inline constexpr std::uint32_t kLeastHits = 4;     ///< Of obstacle voxels in the 3 x 3 columns.
inline constexpr double kLeastDensity = 0.05;      ///< Of these, less one hit each: dust is thinner.
inline constexpr double kSureHits = 0.64;          ///< Variances by which that must be exceeded: 0.8 errors.
inline constexpr std::uint32_t kShadowHits = 10;   ///< In the 3 x 3 columns, for what casts a shadow.
inline constexpr double kLowObstacle_m = 0.1;      ///< Hits so far below an obstacle's height may cast it.
inline constexpr std::int32_t kShadowColumns = 4;  ///< Behind the column.
inline constexpr std::int32_t kLeastDark = 2;      ///< Of these, behind what is high.
inline constexpr double kGradualDensity = 0.25;    ///< Of what casts a high shadow that begins gradually.
inline constexpr double kLowShadow = 0.7;  ///< Of `min_obstacle_height`: so high is a low one's at least.
inline constexpr double kFalls_m = 0.2;    ///< So much lower is its end.

/// Sums over a column's obstacle voxels.
struct ObstacleSums {
  std::uint32_t hits;
  std::uint32_t rays;  ///< Hits and passes.
  std::uint32_t voxels;
  std::uint32_t low_hits;  ///< Of voxels up to `kLowObstacle_m` lower, too.

  GVOM_HD void add(const ObstacleSums& other) {
    hits += other.hits, rays += other.rays, voxels += other.voxels, low_hits += other.low_hits;
  }
};

/// What stands and hangs in a column above its ground.
struct ColumnObstacles {
  ObstacleSums sums;
  std::uint8_t lowest;  ///< The lowest obstacle voxel, if there is one.
  float clearance_m;

  [[nodiscard]] GVOM_HD float density() const {
    if (sums.hits == 0) return 0;
    return static_cast<float>(static_cast<double>(sums.hits) / static_cast<double>(sums.rays));
  }
};

/// Whether a voxel shows what is remembered (R17).
GVOM_HD inline bool is_old(const FusedView& map, std::int32_t x, std::int32_t y, std::int32_t z) {
  if (map.memory.remembered == nullptr) return false;
  return has_bit(map.memory.remembered + map.column(x, y) * static_cast<std::size_t>(map.words), z);
}

/// `presence` without looking where that says enough: no map of the window observes what is old, and of a few
/// passes nothing has left. @param world the voxel, @param matters whether it matters that it is quiet
template <class Maps>
GVOM_HD Presence presence_if(bool old, bool matters, const Maps& maps, const Int3& world, std::uint32_t hits,
                             std::uint32_t passes) {
  if (old) return Presence::quiet;
  if (passes < kMissed && !matters) return Presence::there;
  return presence(maps, world, hits, passes);
}

/// Heights of a column's voxels ascend, so the walk ends at the first one over `max_obstacle_height`.
/// What left its voxel is none, and on ground that the window has nothing old is: it would be seen too.
/// @param maps the window's, @param remembered the column's ground is
template <class Maps>
GVOM_HD ColumnObstacles read_obstacles(const FusedView& map, const Maps& maps, const ColumnParameters& p,
                                       std::int32_t x, std::int32_t y, float ground_m, bool remembered) {
  const std::uint64_t* occupied = map.occupied + map.column(x, y) * static_cast<std::size_t>(map.words);
  ColumnObstacles out{{}, 0, INFINITY};
  std::int32_t left = -2;  // the last voxel that something left
  for (std::int32_t z = lowest_bit(occupied, map.words); z >= 0; z = next_bit(occupied, map.words, z)) {
    const std::size_t cell = map.cell(x, y, z);
    const double above_m = static_cast<double>(map.min_height_m[cell]) - static_cast<double>(ground_m);
    if (above_m > p.layers.max_obstacle_height_m) {
      out.clearance_m = static_cast<float>(above_m);
      break;
    }
    if (above_m < p.layers.min_obstacle_height_m - kLowObstacle_m) continue;
    const bool old = is_old(map, x, y, z);
    if (old && !remembered) continue;
    const std::uint32_t hits = map.hits[cell], passes = map.passes[cell];
    const Int3 world{p.origin[0] + x, p.origin[1] + y, p.origin[2] + z};
    const Presence now = presence_if(old, left == z - 1, maps, world, hits, passes);
    if (now == Presence::left || (now == Presence::quiet && left == z - 1)) {
      left = z;
      if (above_m >= p.layers.min_obstacle_height_m) out.sums.rays += hits + passes;
      continue;
    }
    out.sums.low_hits += hits;
    if (above_m < p.layers.min_obstacle_height_m) continue;
    if (out.sums.voxels == 0) out.lowest = static_cast<std::uint8_t>(z);
    out.sums.add({hits, hits + passes, 1, 0});
  }
  return out;
}

/// The layers that are filled in the 3 x 3 columns around (x, y): one bit for each voxel.
struct FilledLayers {
  static constexpr std::int32_t kWords = 4;  // 256 voxels
  std::uint64_t bits[kWords] = {};

  GVOM_HD FilledLayers(const FusedView& map, std::int32_t x, std::int32_t y) {
    for (std::int32_t dy = -1; dy <= 1; ++dy)
      for (std::int32_t dx = -1; dx <= 1; ++dx) {
        if (!ColumnGrid{map.n_xy}.contains(x + dx, y + dy)) continue;
        const std::uint64_t* mask =
            map.occupied + map.column(x + dx, y + dy) * static_cast<std::size_t>(map.words);
        for (std::int32_t w = 0; w < kWords; ++w)
          if (w < map.words) bits[w] |= mask[w];
      }
  }
};

/// The uppermost layer of the stack that begins at the filled layer `z`, one empty layer at a time being in
/// it: the first one that has two empty layers over it.
GVOM_HD inline std::int32_t top_of_stack(const FilledLayers& layers, std::int32_t z) {
  std::int32_t top = z;
  std::uint64_t above = 0;
  GVOM_UNROLL
  for (std::int32_t w = FilledLayers::kWords - 1; w >= 0; --w) {
    const std::uint64_t word = layers.bits[w];
    const std::uint64_t next_two = (word >> 1 | above << 63) | (word >> 2 | above << 62);
    const std::uint64_t tops = word & ~next_two & bits_from(z - 64 * w);
    if (tops != 0) top = 64 * w + lowest_bit_of(tops);
    above = word;
  }
  return top;
}

/// The highest `min_height` of a layer in the 3 x 3 columns around (x, y).
GVOM_HD inline float height_of_layer_m(const FusedView& map, std::int32_t x, std::int32_t y, std::int32_t z) {
  float highest_m = -INFINITY;
  for (std::int32_t dy = -1; dy <= 1; ++dy)
    for (std::int32_t dx = -1; dx <= 1; ++dx) {
      if (!ColumnGrid{map.n_xy}.contains(x + dx, y + dy)) continue;
      const std::size_t mask = map.column(x + dx, y + dy) * static_cast<std::size_t>(map.words);
      if ((map.occupied[mask + static_cast<std::size_t>(z / 64)] >> (z % 64) & 1) == 0) continue;
      const float height_m = map.min_height_m[map.cell(x + dx, y + dy, z)];
      highest_m = height_m > highest_m ? height_m : highest_m;
    }
  return highest_m;
}

/// Whether the stack over the column's lowest obstacle voxel reaches `max_obstacle_height`, less a voxel.
GVOM_HD inline bool is_tall(const FusedView& map, const ColumnParameters& p, std::int32_t x, std::int32_t y,
                            float ground_m, std::int32_t lowest) {
  const std::int32_t top = top_of_stack(FilledLayers(map, x, y), lowest);
  const auto top_m = static_cast<double>(height_of_layer_m(map, x, y, top));
  return top_m - static_cast<double>(ground_m) >= p.layers.max_obstacle_height_m - p.resolution_z_m;
}

/// How low rays have been in a column that may cast a shadow and behind it: in the window for what the window
/// has there, since rays were behind it when the vehicle was elsewhere; all that is known for what is
/// remembered (R17).
struct ShadowRays {
  const FusedView& map;
  const ColumnGrid& grid;
  const float* lowest_ray_m;  ///< As in GroundView.
  bool remembered;            ///< The column's ground is.

  [[nodiscard]] GVOM_HD float lowest_m(std::int32_t at) const {
    if (remembered) return lowest_ray_m[at];
    const std::int32_t x = grid.x_of(at), y = grid.y_of(at);
    return grid.contains(x, y) ? map.lowest_ray_m[map.stacked_column(x, y)] : kNone_m;
  }
};

/// How high above the ground of a column rays have left it and the columns behind it, as seen from the
/// vehicle.
class Shadow {
 public:
  GVOM_HD Shadow(const ShadowRays& rays, const ColumnParameters& p, std::int32_t x, std::int32_t y,
                 float ground_m)
      : rays_(rays), ground_m_(static_cast<double>(ground_m)), obstacle_m_(p.layers.min_obstacle_height_m) {
    const SightLine line(rays.grid, x, y, p.vehicle_column_x, p.vehicle_column_y);
    beside_ = line.beside();
    in_grid_ = line.columns() > 0 && line.reaches(-kShadowColumns, 0);
    for (std::int32_t behind = 0; behind <= kShadowColumns; ++behind) at_[behind] = line.at(-behind);
  }

  /// Rays were kept from most of the columns behind it up to the height of an obstacle: a beam's gap is
  /// narrow.
  [[nodiscard]] GVOM_HD bool is_high() const {
    if (!in_grid_) return false;
    std::int32_t dark = 0;
    for (std::int32_t behind = 1; behind <= kShadowColumns; ++behind)
      dark += height_m(at_[behind]) >= obstacle_m_ ? 1 : 0;
    return dark >= kLeastDark;
  }

  /// Rays were kept up to the height of an obstacle from this column, the next one, or one abreast of these:
  /// a face. In a bush fewer and fewer come down.
  [[nodiscard]] GVOM_HD bool begins_at_once() const {
    for (std::int32_t behind = 0; behind <= 1; ++behind)
      for (std::int32_t aside = -beside_; aside <= beside_; aside += beside_)
        if (height_m(at_[behind] + aside) >= obstacle_m_) return true;
    return false;
  }

  /// Rays were kept from this column and the next one, or from two abreast of these, up to most of the height
  /// of an obstacle, and come down again behind: there is a rock. Behind a bush fewer and fewer come down.
  [[nodiscard]] GVOM_HD bool is_low() const {
    if (!in_grid_) return false;
    for (std::int32_t aside = -beside_; aside <= beside_; aside += beside_) {
      const double own_m = height_m(at_[0] + aside), next_m = height_m(at_[1] + aside);
      if (own_m == static_cast<double>(kNone_m) || next_m == static_cast<double>(kNone_m)) continue;
      const double top_m = own_m > next_m ? own_m : next_m;
      if (top_m >= kLowShadow * obstacle_m_ && height_m(at_[kShadowColumns] + aside) < top_m - kFalls_m)
        return true;
    }
    return false;
  }

 private:
  [[nodiscard]] GVOM_HD double height_m(std::int32_t at) const {
    return static_cast<double>(rays_.lowest_m(at)) - ground_m_;
  }

  const ShadowRays& rays_;
  double ground_m_;
  double obstacle_m_;
  std::int32_t beside_;
  std::int32_t at_[kShadowColumns + 1];
  bool in_grid_;
};

/// Hits and rays of the 3 x 3 columns, less a hit for each voxel: that for which it is looked at at all.
struct Spare {
  double hits, rays;

  GVOM_HD explicit Spare(const ObstacleSums& around)
      : hits(static_cast<double>(around.hits) - around.voxels),
        rays(static_cast<double>(around.rays) - around.voxels) {}

  [[nodiscard]] GVOM_HD bool reaches(double density) const { return hits >= density * rays; }

  /// Surely no dust: the share of few hits is uncertain by their root.
  [[nodiscard]] GVOM_HD bool is_surely_thick() const {
    const double over = hits - kLeastDensity * rays;
    return over > 0 && over * over >= kSureHits * hits;
  }
};

/// Flags of a column with known ground (R11). @param own its own sums, @param around those of the 3 x 3
/// columns, @param lowest its lowest obstacle voxel
GVOM_HD inline std::uint8_t obstacle_flags(const ShadowRays& behind, const ColumnParameters& p,
                                           std::int32_t x, std::int32_t y, float ground_m,
                                           const ObstacleSums& own, const ObstacleSums& around,
                                           std::int32_t lowest) {
  const Spare spare(around);
  if (around.low_hits >= kShadowHits) {
    const Shadow shadow(behind, p, x, y, ground_m);
    const bool casts_high =
        own.low_hits > 0 && shadow.is_high() && (shadow.begins_at_once() || spare.reaches(kGradualDensity));
    if (casts_high || shadow.is_low()) return kHard;
  }
  if (own.hits == 0) return 0;
  if (around.hits < kLeastHits) return kSoft;
  if (spare.rays > 0 && spare.reaches(p.layers.density_threshold)) return kHard;
  return spare.is_surely_thick() && is_tall(behind.map, p, x, y, ground_m, lowest) ? kHard : kSoft;
}

}  // namespace gvom
