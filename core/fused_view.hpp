// The fused map as the layers read it: dense bricks and column masks, addressed toroidally. A world
// brick's place is its index modulo the grid, so the map moves without anything being shifted.
#pragma once

#include <cstdint>

#include "core/grid.hpp"
#include "core/memory.hpp"

namespace gvom {

/// `value` modulo `n`, in 0 .. n - 1 also for negative values.
GVOM_HD inline std::int32_t wrap(std::int32_t value, std::int32_t n) {
  const std::int32_t rest = value % n;
  return rest < 0 ? rest + n : rest;
}

/// The toroidal place of a grid's origin, voxels.
inline Int3 toroidal_origin(const Grid& grid) {
  return {wrap(grid.origin[0], grid.size[0]), wrap(grid.origin[1], grid.size[1]),
          wrap(grid.origin[2], grid.size[2])};
}

/// No map of the window observed the column.
inline constexpr std::int64_t kNeverSeen = INT64_MIN;

/// What the fused map remembers beyond its window (R17). Null pointers where it does not.
struct MemoryView {
  const std::uint64_t* remembered;   ///< [column][word]: the voxel shows what is remembered.
  const RememberedHits* hits;        ///< [cell]
  const RememberedPasses* passes;    ///< [cell]
  const std::uint8_t* column_beats;  ///< [column_in_stacks]: of the newest map that left.
  const float* lowest_ray_m;         ///< [column_in_stacks]: of maps that left, or +infinity.
  // Shorter ways to what `hits` says, where a back end has them: most voxels have nothing there.
  const std::uint8_t* hit_bits = nullptr;    ///< Bit cell % 8 of [cell / 8]: `hits` has something.
  const std::uint16_t* hit_beats = nullptr;  ///< [cell]: its beat, in the low byte.

  [[nodiscard]] GVOM_HD bool may_be_hit(std::size_t cell) const {
    return hit_bits == nullptr || (hit_bits[cell / 8] >> (cell % 8) & 1) != 0;
  }
  /// Of a voxel of which hits are remembered.
  [[nodiscard]] GVOM_HD std::uint8_t beat_of_hits(std::size_t cell) const {
    return hit_beats == nullptr ? hits[cell].beat() : static_cast<std::uint8_t>(hit_beats[cell]);
  }
};

/// Pointers into the fused map. x, y, z are relative to the origin.
struct FusedView {
  std::int32_t n_xy;
  std::int32_t n_z;
  std::int32_t words;  ///< 64-bit words of a column's mask.
  Int3 first;          ///< `toroidal_origin` of the grid.
  const std::uint32_t* hits;
  const std::uint32_t* passes;
  const float* min_height_m;
  const std::uint64_t* occupied;     ///< [column][word], bit z from the origin up: hits >= min_hits (R8).
  const std::uint64_t* free;         ///< [column][word]: observed and not occupied (R8).
  const std::int64_t* last_seen_ns;  ///< [column]: newest stamp that observed it, or kNeverSeen (R15).
  const float* lowest_ray_m;         ///< [column_in_stacks]: lowest point of a ray (R5a), or +infinity.
  MemoryView memory;
  const std::uint64_t* solid = nullptr;  ///< [column][word]: occupied and not worn (R8), if it is known.

  GVOM_HD std::int32_t torus(std::int32_t i, int axis) const {
    const std::int32_t n = axis == 2 ? n_z : n_xy;
    const std::int32_t place = first[static_cast<std::size_t>(axis)] + i;
    return place >= n ? place - n : place;
  }
  /// Index of a column in the masks and in `last_seen_ns`.
  GVOM_HD std::size_t column(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(torus(y, 1)) * static_cast<std::size_t>(n_xy) +
           static_cast<std::size_t>(torus(x, 0));
  }
  /// Index of a column in `lowest_ray_m`.
  [[nodiscard]] GVOM_HD std::size_t stacked_column(std::int32_t x, std::int32_t y) const {
    return column_in_stacks(torus(x, 0), torus(y, 1), n_xy / kBrickEdge);
  }
  /// Index of a voxel in `hits`, `passes` and `min_height_m`.
  GVOM_HD std::size_t cell(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const std::int32_t tx = torus(x, 0), ty = torus(y, 1), tz = torus(z, 2);
    const std::int32_t n = n_xy / kBrickEdge;
    return std::size_t{brick_slot(tx >> 3, ty >> 3, tz >> 3, n, n)} * kBrickCells + cell_in_brick(tx, ty, tz);
  }
};

}  // namespace gvom
