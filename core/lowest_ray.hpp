// How low rays have been in a column (R5a), for host and device.
//
// A ray that leaves a column has found nothing in it on its way. Where it leaves, over an x or a y face, its
// height is a fixed-point number: that at the first face is rounded once, the others are steps of one rounded
// size from there, so that every machine finds the same (0.8 mm off after 256 voxels of 0.4 m, at most).
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
  std::uint32_t next = 0;
  std::uint32_t step = 0;

  /// The height at the next face, and on to the one behind it, if the ray `crosses` that.
  GVOM_HD std::int32_t take_if(bool crosses) {
    const auto height = static_cast<std::int32_t>(next);
    next += crosses ? step : 0;
    return height;
  }
};

/// @param along_z, along what the ray goes along z and along the axis, @param offset its way to the first
/// face along the axis, all fixed
GVOM_HD inline FaceHeights face_heights(std::int64_t from_z, std::int64_t along_z, std::int64_t offset,
                                        std::int64_t along) {
  const double one = static_cast<double>(kFixedOne);
  const double slope = static_cast<double>(along_z) / one * (1 / (static_cast<double>(along) / one));
  const double first = static_cast<double>(from_z) / one + slope * (static_cast<double>(offset) / one);
  return {round_to_32_bits(first * kHeightOne), round_to_32_bits(slope * kHeightOne)};
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
    const RayAxis x = ray_axis(from[0], to[0]), y = ray_axis(from[1], to[1]);
    step_x_ = x.step, step_y_ = y.step;
    const std::int64_t along_z = to[2] - from[2];
    if (x.crossings > 0) over_x_ = face_heights(from[2], along_z, x.offset, x.length);
    if (y.crossings > 0) over_y_ = face_heights(from[2], along_z, y.offset, y.length);
  }

  /// The next step of the walk, over a face of `axis` (0: x, 1: y), into the column (x, y).
  GVOM_HD ColumnLeft leave(int axis, std::int32_t x, std::int32_t y) {
    const bool over_x = axis == 0;
    const std::int32_t at_x = over_x_.take_if(over_x), at_y = over_y_.take_if(!over_x);
    return {over_x ? x - step_x_ : x, over_x ? y : y - step_y_, over_x ? at_x : at_y};
  }

 private:
  std::int32_t step_x_, step_y_;
  FaceHeights over_x_, over_y_;
};

}  // namespace gvom
