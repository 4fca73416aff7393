// What one column of the fused map means (R9..R11, R13..R16), for host and device.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/column_bits.hpp"
#include "core/config.hpp"
#include "core/format/layers.hpp"
#include "core/fused_view.hpp"
#include "core/ground.hpp"
#include "core/negative.hpp"
#include "core/window.hpp"

namespace gvom {

/// Everything the column formulas need besides the map, as plain numbers.
struct ColumnParameters {
  std::int32_t origin[3];
  double resolution_xy_m;
  double resolution_z_m;
  double vehicle_x_m, vehicle_y_m, vehicle_radius_m;
  std::int32_t vehicle_column_x, vehicle_column_y;  ///< From the origin.
  double ground_under_vehicle_m;
  double ground_slope_x, ground_slope_y;  ///< Of the plane that the vehicle stands on, m/m.
  std::int64_t stamp_ns;
  LayersConfig layers;
  CostConfig cost;
};

/// A vehicle that leans more, by the cosine, stands on no plane that says anything: on level ground, then.
inline constexpr double kLeastUpright = 0.5;

inline ColumnParameters column_parameters(const MapperConfig& config, const LayerMoment& moment) {
  const Grid& grid = moment.grid;
  const Eigen::Vector3d& base_m = moment.T_odom_base.translation_m;
  const Eigen::Vector3d up = moment.T_odom_base.rotation.toRotationMatrix().col(2);
  const double per_up = up.z() > kLeastUpright ? 1 / up.z() : 0;
  const auto column = [&](Eigen::Index axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double voxel = std::floor(voxel_coordinate(base_m[axis], grid.resolution_m[a]));
    return static_cast<std::int32_t>(voxel - grid.origin[a]);
  };
  return {{grid.origin[0], grid.origin[1], grid.origin[2]},
          grid.resolution_m[0],
          grid.resolution_m[2],
          base_m.x(),
          base_m.y(),
          config.vehicle.radius_m,
          column(0),
          column(1),
          base_m.z() - config.vehicle.base_height_m,
          -up.x() * per_up,
          -up.y() * per_up,
          moment.stamp_ns,
          config.layers,
          config.cost};
}

/// Ground may be assumed where the column's centre is within the vehicle's radius (R9): on the plane that the
/// vehicle stands on, metres; else kNone_m.
GVOM_HD inline float assumed_ground_m(const ColumnParameters& p, std::int32_t x, std::int32_t y) {
  const double dx_m = (p.origin[0] + x + 0.5) * p.resolution_xy_m - p.vehicle_x_m;
  const double dy_m = (p.origin[1] + y + 0.5) * p.resolution_xy_m - p.vehicle_y_m;
  if (!(std::sqrt(dx_m * dx_m + dy_m * dy_m) <= p.vehicle_radius_m)) return kNone_m;
  return static_cast<float>(p.ground_under_vehicle_m + (p.ground_slope_x * dx_m + p.ground_slope_y * dy_m));
}

GVOM_HD inline bool is_worn(const FusedView& map, std::size_t cell) {
  return is_worn(map.hits[cell], map.passes[cell]);
}

/// The lowest occupied voxel that rays have not worn away (R8), or -1.
GVOM_HD inline std::int32_t lowest_solid(const FusedView& map, std::int32_t x, std::int32_t y) {
  const std::size_t mask = map.column(x, y) * static_cast<std::size_t>(map.words);
  if (map.solid != nullptr) return lowest_bit(map.solid + mask, map.words);
  const std::uint64_t* occupied = map.occupied + mask;
  std::int32_t z = lowest_bit(occupied, map.words);
  while (z >= 0 && is_worn(map, map.cell(x, y, z))) z = next_bit(occupied, map.words, z);
  return z;
}

/// The next solid voxel of a column above `z` that the window has itself (R17), or -1.
GVOM_HD inline std::int32_t next_solid_of_window(const FusedView& map, std::int32_t x, std::int32_t y,
                                                 std::int32_t z) {
  const std::size_t mask = map.column(x, y) * static_cast<std::size_t>(map.words);
  const bool knows_solid = map.solid != nullptr;
  const std::uint64_t* const voxels = (knows_solid ? map.solid : map.occupied) + mask;
  do z = next_bit(voxels, map.words, z);
  while (z >= 0 &&
         (has_bit(map.memory.remembered + mask, z) || (!knows_solid && is_worn(map, map.cell(x, y, z)))));
  return z;
}

/// The voxel whose lowest return is a column's own (R9), or -1 and kNone_m. It is remembered or not (R17).
struct LowestVoxel {
  std::int32_t z;
  bool remembered;
  float lowest_m;
};

/// Ground that the window's rays only graze (R17): they were in its voxel, in no lower one, and not below
/// what was hit there before. @param z the column's lowest solid voxel, or -1
GVOM_HD inline LowestVoxel grazed_voxel(const FusedView& map, const ColumnParameters& p, std::int32_t x,
                                        std::int32_t y, std::int32_t z) {
  constexpr LowestVoxel kNothing{-1, false, kNone_m};
  const std::size_t mask = map.column(x, y) * static_cast<std::size_t>(map.words);
  const std::int32_t lowest_free = lowest_bit(map.free + mask, map.words);
  if (lowest_free < 0 || (z >= 0 && lowest_free > z)) return kNothing;
  if (has_bit(map.memory.remembered + mask, lowest_free)) return kNothing;
  const std::size_t cell = map.cell(x, y, lowest_free);
  if (!map.memory.may_be_hit(cell)) return kNothing;
  const RememberedHits& hits = map.memory.hits[cell];
  if (hits.bits == 0 || map.hits[cell] != 0) return kNothing;
  if (!(map.lowest_ray_m[map.stacked_column(x, y)] >= hits.min_height_m)) return kNothing;
  const auto now = static_cast<std::uint8_t>(beat_of(p.stamp_ns));
  const VoxelRecord told = shown_voxel(hits, map.memory.passes[cell], now);
  if (!is_occupied(told.hits, static_cast<std::uint32_t>(p.layers.min_hits))) return kNothing;
  return {lowest_free, true, told.min_height_m};
}

/// What the window has counts before what is remembered below it, but for what hangs by its own rays (R17).
/// @param z the column's lowest solid voxel, which is remembered
GVOM_HD inline LowestVoxel remembered_voxel(const FusedView& map, std::int32_t x, std::int32_t y,
                                            std::int32_t z) {
  const LowestVoxel own{z, true, map.min_height_m[map.cell(x, y, z)]};
  const std::int32_t seen = next_solid_of_window(map, x, y, z);
  if (seen < 0) return own;
  const float seen_m = map.min_height_m[map.cell(x, y, seen)];
  const bool hangs = seen_m - map.lowest_ray_m[map.stacked_column(x, y)] > kHangs_m;
  return seen != z + 1 && hangs ? own : LowestVoxel{seen, false, seen_m};
}

GVOM_HD inline LowestVoxel lowest_voxel(const FusedView& map, const ColumnParameters& p, std::int32_t x,
                                        std::int32_t y) {
  const std::int32_t z = lowest_solid(map, x, y);
  if (map.memory.remembered != nullptr) {
    const LowestVoxel grazed = grazed_voxel(map, p, x, y, z);
    if (grazed.z >= 0) return grazed;
    const std::size_t mask = map.column(x, y) * static_cast<std::size_t>(map.words);
    if (z >= 0 && has_bit(map.memory.remembered + mask, z)) return remembered_voxel(map, x, y, z);
  }
  return {z, false, z < 0 ? kNone_m : map.min_height_m[map.cell(x, y, z)]};
}

/// Whether rays went below voxel `z` of a column (R9): one left the column lower, and a voxel further down
/// was passed at least as often as this one was hit.
GVOM_HD inline bool hangs(const FusedView& map, std::int32_t x, std::int32_t y, std::int32_t z,
                          float lowest_m, float lowest_ray_m) {
  if (!(lowest_m - lowest_ray_m > kHangs_m)) return false;
  const std::uint64_t* free = map.free + map.column(x, y) * static_cast<std::size_t>(map.words);
  const std::uint32_t hits = map.hits[map.cell(x, y, z)];
  for (std::int32_t below = lowest_bit(free, map.words); below >= 0 && below < z;
       below = next_bit(free, map.words, below))
    if (map.passes[map.cell(x, y, below)] >= hits) return true;
  return false;
}

/// What a column's own voxels say of the ground (R9, R10, R15).
struct ColumnGround {
  float inferred_height;
  float last_seen;
  float lowest_ray_m;  ///< Of the window, or remembered too (R17).
  float lowest_m;      ///< Of its lowest return, or kNone_m.
  float ground_m;      ///< Seen or assumed, or kNone_m.
  bool assumed;
  bool observed;
  bool remembered;
};

/// Seconds from a stamp to the layers'.
GVOM_HD inline float age_s(std::int64_t age_ns) {
  return static_cast<float>(static_cast<double>(age_ns) * 1e-9);
}

/// R15. @param lowest see `lowest_voxel`, @param observed the column has a solid or a free voxel
GVOM_HD inline float last_seen_s(const FusedView& map, const ColumnParameters& p, std::int32_t x,
                                 std::int32_t y, const LowestVoxel& lowest, bool observed) {
  if (lowest.remembered)
    return age_s(time_since(map.memory.beat_of_hits(map.cell(x, y, lowest.z)), p.stamp_ns));
  const std::int64_t seen_ns = map.last_seen_ns[map.column(x, y)];
  if (seen_ns != kNeverSeen) return age_s(p.stamp_ns - seen_ns);
  if (!observed) return kUnknown;
  return age_s(time_since(map.memory.column_beats[map.stacked_column(x, y)], p.stamp_ns));
}

/// Rays over what is nearer look down on it no more, so it is judged by remembered ones too, metres.
inline constexpr double kLooksOver_m = 8;

/// The lowest point of a ray by which a column is judged (R5a, R17).
GVOM_HD inline float lowest_ray_m(const FusedView& map, const ColumnParameters& p, std::int32_t x,
                                  std::int32_t y, const LowestVoxel& lowest) {
  const std::size_t column = map.stacked_column(x, y);
  const float seen_m = map.lowest_ray_m[column];
  if (map.memory.lowest_ray_m == nullptr || (lowest.z >= 0 && !lowest.remembered)) return seen_m;
  const std::int32_t dx = x - p.vehicle_column_x, dy = y - p.vehicle_column_y;
  const double square_m2 = p.resolution_xy_m * p.resolution_xy_m * (dx * dx + dy * dy);
  if (lowest.z < 0 && seen_m != kNone_m && square_m2 > kLooksOver_m * kLooksOver_m) return seen_m;
  return lower(seen_m, map.memory.lowest_ray_m[column]);
}

GVOM_HD inline ColumnGround read_ground(const FusedView& map, const ColumnParameters& p, std::int32_t x,
                                        std::int32_t y) {
  const std::size_t column = map.column(x, y);
  const std::int32_t lowest_free =
      lowest_bit(map.free + column * static_cast<std::size_t>(map.words), map.words);
  const LowestVoxel lowest = lowest_voxel(map, p, x, y);
  ColumnGround out{kUnknown, kUnknown, kNone_m, kNone_m, kNone_m, false, false, false};
  out.observed = lowest_free >= 0 || lowest.z >= 0;
  out.remembered = lowest.z >= 0 ? lowest.remembered : map.last_seen_ns[column] == kNeverSeen;
  out.lowest_ray_m = lowest_ray_m(map, p, x, y, lowest);
  out.last_seen = last_seen_s(map, p, x, y, lowest, out.observed);
  if (lowest_free >= 0)
    out.inferred_height = static_cast<float>((p.origin[2] + lowest_free) * p.resolution_z_m);
  if (lowest.z < 0) {
    out.ground_m = assumed_ground_m(p, x, y);
    out.assumed = out.ground_m != kNone_m;
    return out;
  }
  out.lowest_m = lowest.lowest_m;
  if (hangs(map, x, y, lowest.z, out.lowest_m, out.lowest_ray_m)) return out;
  const float below_m = out.lowest_m - out.lowest_ray_m;
  out.ground_m = below_m > kBlades_m && below_m <= kHangs_m ? out.lowest_ray_m : out.lowest_m;
  return out;
}

/// R15, where a lowest return that hangs finds its ground.
GVOM_HD inline Visibility visibility_of(const ColumnGround& column) {
  if (column.assumed) return Visibility::ground_assumed;
  if (!column.observed) return Visibility::unobserved;
  if (column.remembered) return Visibility::remembered;
  return column.lowest_m != kNone_m ? Visibility::ground_seen : Visibility::free_only;
}

/// R15 of a column that hangs and finds no ground around it.
GVOM_HD inline std::uint8_t without_height(std::uint8_t visibility) {
  return is_remembered(visibility) ? visibility : static_cast<std::uint8_t>(Visibility::free_only);
}

/// `height` of a column (R9) that the columns around it are asked for, or kNone_m: its lowest return hangs,
/// or its ground stands out or is doubtful. `at` indexes the view. @param lowest_m as in ColumnGround,
/// @param standing of `Standing`
GVOM_HD inline float height_by_rims_m(const GroundView& view, std::int32_t at, float lowest_m,
                                      std::uint8_t standing, double resolution_m) {
  const float ground_m = view.ground_m[at];
  const bool doubtful = (standing & kDoubtful) != 0 && lowest_m != kNone_m;
  const bool hangs =
      ground_m == kNone_m || (doubtful && !is_face(view, at) && !is_carried(view, at, resolution_m));
  if (!hangs && (standing & kStandsOut) == 0) return ground_m;
  const float between_m = ground_between_rims(view, at);
  if (between_m == kNone_m) return hangs ? kNone_m : ground_m;
  return lower_of(between_m, ground_m == kNone_m ? lowest_m : ground_m);
}

inline HoleParameters hole_parameters(const ColumnParameters& p) {
  const std::int32_t reach = p.layers.search_distance;
  return {p.resolution_xy_m,
          kHoleShare * p.layers.negative_threshold_m,
          kEdgeShare * p.layers.negative_threshold_m,
          reach,
          reach * 2 / 5,
          p.vehicle_column_x,
          p.vehicle_column_y,
          pit_depths(p.resolution_xy_m, p.layers.negative_threshold_m)};
}

/// One byte of cost from a column's layers (R16).
GVOM_HD inline std::uint8_t column_cost(const CostConfig& c, std::uint8_t flags, float height, float density,
                                        float slope, float roughness) {
  if (flags & (kHard | kNegative | kSteep)) return 254;
  if (std::isnan(height)) return 255;
  const double steepness = std::isnan(slope) ? 0 : static_cast<double>(slope) / c.slope_full_rad;
  const double unevenness = std::isnan(roughness) ? 0 : static_cast<double>(roughness) / c.roughness_full_m2;
  const double sum =
      (c.soft_weight * static_cast<double>(density) + c.slope_weight * (steepness < 1 ? steepness : 1)) +
      c.roughness_weight * (unevenness < 1 ? unevenness : 1);
  const double share = sum / ((c.soft_weight + c.slope_weight) + c.roughness_weight);
  return static_cast<std::uint8_t>(252 * (share < 1 ? share : 1));
}

}  // namespace gvom
