// How low rays have been in a column (R5a), for host and device.
//
// A ray that leaves a column has found nothing in it on its way. Where it leaves, over an x or a y face, its
// height is a fixed-point number: that at the first face is rounded once, the others are steps of one rounded
// size from there, so that every machine finds the same (at most 2 mm off after 256 voxels of 0.4 m).
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>

#include "core/format/brick_map.hpp"
#include "core/ray.hpp"

namespace gvom {

inline constexpr int kHeightBits = 16;
/// Units of a ray's height in a voxel.
inline constexpr double kHeightOne = 1 << kHeightBits;

/// No ray left the column: a height over all others.
inline constexpr std::int32_t kNoRay = std::numeric_limits<std::int32_t>::max();

/// The nearest whole number, modulo 2^32, of a value below 2^51.
GVOM_HD inline std::uint32_t round_to_32_bits(double value) {
  const double shifted = value + 0x1.8p52;
  std::int64_t bits;
  memcpy(&bits, &shifted, sizeof bits);
  return static_cast<std::uint32_t>(bits);
}

/// Heights of a ray where it crosses the faces of the x or the y axis, from the grid's origin; they are right
/// within the grid, modulo 2^32 elsewhere.
struct FaceHeights {
  std::uint32_t first;
  std::uint32_t step;

  /// At the crossing number `k`, from 0.
  [[nodiscard]] GVOM_HD std::int32_t at(std::uint32_t k) const {
    return static_cast<std::int32_t>(first + k * step);
  }
};

/// @param first at the first face, @param step from face to face: `units` of these are a voxel, a power of
/// two
GVOM_HD inline FaceHeights face_heights(double first, double step, double units) {
  return {round_to_32_bits(first * (kHeightOne / units)), round_to_32_bits(step * (kHeightOne / units))};
}

/// Metres in odom, like `min_height_m`.
GVOM_HD inline float height_of_ray_m(std::int32_t height, std::int32_t origin_z, double resolution_z_m) {
  if (height == kNoRay) return kNoRay_m;
  return static_cast<float>((origin_z + height / kHeightOne) * resolution_z_m) + 0.0f;
}

/// A column that a ray left, and its height there.
struct ColumnLeft {
  std::int32_t x;
  std::int32_t y;
  std::int32_t height;
};

/// Where a ray leaves columns while it is walked.
class RayHeights {
 public:
  GVOM_HD RayHeights(const std::int64_t (&from)[3], const std::int64_t (&to)[3]) {
    const double one = static_cast<double>(kFixedOne);
    const double z = static_cast<double>(from[2]) / one;
    const double along_z = static_cast<double>(to[2] - from[2]) / one;
    for (int a = 0; a < 2; ++a) {
      const RayAxis axis = ray_axis(from[a], to[a]);
      step_[a] = axis.step;
      if (axis.crossings == 0) continue;
      const double slope = along_z * (1 / (static_cast<double>(axis.length) / one));
      heights_[a] = face_heights(z + slope * (static_cast<double>(axis.offset) / one), slope, 1);
    }
  }

  /// The next step of the walk, over a face of `axis` (0: x, 1: y), into the column (x, y).
  GVOM_HD ColumnLeft leave(int axis, std::int32_t x, std::int32_t y) {
    const std::int32_t height = heights_[axis].at(crossed_[axis]++);
    return {axis == 0 ? x - step_[0] : x, axis == 1 ? y - step_[1] : y, height};
  }

 private:
  std::int32_t step_[2];
  FaceHeights heights_[2] = {};
  std::uint32_t crossed_[2] = {};
};

}  // namespace gvom
