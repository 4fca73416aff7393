// What one column of the fused map means (R9..R11, R13..R16), for host and device.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/config.hpp"
#include "core/format/layers.hpp"
#include "core/fused_view.hpp"
#include "core/window.hpp"

namespace gvom {

/// Everything the column formulas need besides the map, as plain numbers.
struct ColumnParameters {
  std::int32_t origin[3];
  double resolution_xy_m;
  double resolution_z_m;
  double vehicle_x_m, vehicle_y_m, vehicle_radius_m;
  float ground_under_vehicle_m;
  std::int64_t stamp_ns;
  LayersConfig layers;
  CostConfig cost;
};

inline ColumnParameters column_parameters(const MapperConfig& config, const LayerMoment& moment) {
  const Grid& grid = moment.grid;
  const Eigen::Vector3d& base_m = moment.T_odom_base.translation_m;
  return {{grid.origin[0], grid.origin[1], grid.origin[2]},
          grid.resolution_m[0],
          grid.resolution_m[2],
          base_m.x(),
          base_m.y(),
          config.vehicle.radius_m,
          static_cast<float>(base_m.z() - config.vehicle.base_height_m),
          moment.stamp_ns,
          config.layers,
          config.cost};
}

/// What a column's own voxels say.
struct Column {
  float height;
  float inferred_height;
  float obstacle_density;
  float clearance;
  float last_seen;
  std::uint8_t flags;
  std::uint8_t visibility;
};

/// Puts it into the layers, at index `i` of their arrays.
GVOM_HD inline void write_column(const Column& column, const LayerArrays& out, std::int32_t i) {
  out.height[i] = column.height;
  out.inferred_height[i] = column.inferred_height;
  out.obstacle_density[i] = column.obstacle_density;
  out.clearance[i] = column.clearance;
  out.last_seen[i] = column.last_seen;
  out.flags[i] = column.flags;
  out.visibility[i] = column.visibility;
}

/// Whether ground may be assumed in a column (R9): its centre lies within the vehicle's radius.
GVOM_HD inline bool under_vehicle(const ColumnParameters& p, std::int32_t x, std::int32_t y) {
  const double dx_m = (p.origin[0] + x + 0.5) * p.resolution_xy_m - p.vehicle_x_m;
  const double dy_m = (p.origin[1] + y + 0.5) * p.resolution_xy_m - p.vehicle_y_m;
  return std::sqrt(dx_m * dx_m + dy_m * dy_m) <= p.vehicle_radius_m;
}

/// Index of the lowest set bit of a column's mask, or -1.
GVOM_HD inline std::int32_t lowest_bit(const std::uint64_t* mask, std::int32_t words) {
  for (std::int32_t w = 0; w < words; ++w) {
    if (mask[w] == 0) continue;
#ifdef __CUDA_ARCH__
    return w * 64 + __ffsll(static_cast<long long>(mask[w])) - 1;
#else
    return w * 64 + __builtin_ctzll(mask[w]);
#endif
  }
  return -1;
}

/// The next set bit above `bit`, or -1.
GVOM_HD inline std::int32_t next_bit(const std::uint64_t* mask, std::int32_t words, std::int32_t bit) {
  const std::int32_t word = bit / 64;
  const std::uint64_t above = bit % 64 == 63 ? 0 : mask[word] & (~std::uint64_t{0} << (bit % 64 + 1));
  if (above != 0) return word * 64 + lowest_bit(&above, 1);
  const std::int32_t next = lowest_bit(mask + word + 1, words - word - 1);
  return next < 0 ? -1 : (word + 1) * 64 + next;
}

/// The highest set bit up to and with `bit`, or -1.
GVOM_HD inline std::int32_t last_bit_up_to(const std::uint64_t* mask, std::int32_t bit) {
  std::uint64_t bits = mask[bit / 64] & (~std::uint64_t{0} >> (63 - bit % 64));
  for (std::int32_t word = bit / 64;; bits = mask[--word]) {
    if (bits != 0) {
#ifdef __CUDA_ARCH__
      return word * 64 + 63 - __clzll(static_cast<long long>(bits));
#else
      return word * 64 + 63 - __builtin_clzll(bits);
#endif
    }
    if (word == 0) return -1;
  }
}

/// Obstacles and clearance above the ground (R11, R14). Heights of a column's voxels ascend, so the walk
/// ends at the first one over `max_obstacle_height`.
GVOM_HD inline void obstacles_above(const FusedView& map, const ColumnParameters& p, std::int32_t x,
                                    std::int32_t y, std::int32_t z, Column& out) {
  const std::uint64_t* occupied = map.occupied + map.column(x, y) * static_cast<std::size_t>(map.words);
  std::uint64_t hits = 0;
  std::uint64_t rays = 0;
  for (; z >= 0; z = next_bit(occupied, map.words, z)) {
    const std::size_t cell = map.cell(x, y, z);
    const double above_m = static_cast<double>(map.min_height_m[cell]) - static_cast<double>(out.height);
    if (above_m > p.layers.max_obstacle_height_m) {
      out.clearance = static_cast<float>(above_m);
      break;
    }
    if (above_m < p.layers.min_obstacle_height_m) continue;
    hits += map.hits[cell];
    rays += std::uint64_t{map.hits[cell]} + map.passes[cell];
  }
  if (hits == 0) return;
  const double density = static_cast<double>(hits) / static_cast<double>(rays);
  out.obstacle_density = static_cast<float>(density);
  out.flags |= density >= p.layers.density_threshold ? kHard : kSoft;
}

/// Everything of a column that does not depend on its neighbours (R9, R10, R11, R14, R15).
GVOM_HD inline Column read_column(const FusedView& map, const ColumnParameters& p, std::int32_t x,
                                  std::int32_t y) {
  const std::size_t column = map.column(x, y);
  const std::size_t mask = column * static_cast<std::size_t>(map.words);
  const std::int32_t ground = lowest_bit(map.occupied + mask, map.words);
  const std::int32_t lowest_free = lowest_bit(map.free + mask, map.words);
  const bool assumed = ground < 0 && under_vehicle(p, x, y);
  Column out{
      kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, 0, static_cast<std::uint8_t>(Visibility::unobserved)};
  if (lowest_free >= 0) {
    out.inferred_height = static_cast<float>((p.origin[2] + lowest_free) * p.resolution_z_m);
    out.visibility = static_cast<std::uint8_t>(Visibility::free_only);
  }
  if (map.last_seen_ns[column] != kNeverSeen)
    out.last_seen = static_cast<float>(static_cast<double>(p.stamp_ns - map.last_seen_ns[column]) * 1e-9);
  if (ground < 0 && !assumed) return out;
  out.obstacle_density = 0;
  out.clearance = INFINITY;
  if (assumed) {
    out.height = p.ground_under_vehicle_m;
    out.flags = kAssumed;
    out.visibility = static_cast<std::uint8_t>(Visibility::ground_assumed);
    return out;
  }
  out.height = map.min_height_m[map.cell(x, y, ground)];
  out.visibility = static_cast<std::uint8_t>(Visibility::ground_seen);
  obstacles_above(map, p, x, y, ground, out);
  return out;
}

/// Only a column that rays went over without finding ground can hide a hole (R13).
GVOM_HD inline bool seen_through(float height, float inferred_height) {
  return std::isnan(height) && !std::isnan(inferred_height);
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
