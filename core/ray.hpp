// Exact rays through the voxel grid (R5), the same on every machine.
//
// Coordinates are fixed-point: 26 bits below the voxel, plus a half of the last one, so that no end
// point lies on a voxel's face. A ray is then a start voxel and a set of face crossings; crossing k of
// an axis happens at the exact fraction  offset(k) / length  of the way, and the crossings, in order of
// that fraction (ties: x before y before z), are the Amanatides-Woo walk.
#pragma once

#include <cstdint>

#include "core/format/platform.hpp"

namespace gvom {

inline constexpr int kFractionBits = 26;
/// Units of a fixed coordinate in a voxel; twice 2^26, because of the half.
inline constexpr std::int64_t kFixedOne = std::int64_t{2} << kFractionBits;

/// A coordinate in voxels as a fixed-point number relative to the grid's origin; its voxel,
/// `floor(voxels) - origin`, is kept exactly.
GVOM_HD inline std::int64_t to_fixed(double voxels, std::int32_t origin) {
  const double scaled = voxels * static_cast<double>(kFixedOne / 2);
  const std::int64_t towards_zero = static_cast<std::int64_t>(scaled);
  const std::int64_t down = towards_zero - (scaled < static_cast<double>(towards_zero) ? 1 : 0);
  return 2 * (down - static_cast<std::int64_t>(origin) * (kFixedOne / 2)) + 1;
}

/// The voxel of a fixed coordinate.
GVOM_HD inline std::int32_t fixed_voxel(std::int64_t fixed) {
  return static_cast<std::int32_t>(fixed >> (kFractionBits + 1));
}

/// One axis of a ray.
struct RayAxis {
  std::int32_t voxel;      ///< Of the start, then of the walk.
  std::int32_t step;       ///< +1 or -1.
  std::int32_t crossings;  ///< Faces still to cross.
  std::int64_t offset;     ///< From the start to the next face, fixed.
  std::int64_t length;     ///< From the start to the end, fixed.
};

GVOM_HD inline RayAxis ray_axis(std::int64_t from, std::int64_t to) {
  RayAxis axis;
  axis.voxel = fixed_voxel(from);
  const std::int32_t last = fixed_voxel(to);
  const bool forward = to >= from;
  axis.step = forward ? 1 : -1;
  axis.crossings = forward ? last - axis.voxel : axis.voxel - last;
  const std::int64_t face = static_cast<std::int64_t>(axis.voxel + (forward ? 1 : 0)) * kFixedOne;
  axis.offset = forward ? face - from : from - face;
  axis.length = forward ? to - from : from - to;
  return axis;
}

/// Whether the next crossing of `a` comes before that of `b`; `a` is the lower axis and wins a tie.
GVOM_HD inline bool crosses_first(const RayAxis& a, const RayAxis& b) {
  if (a.crossings == 0) return false;
  if (b.crossings == 0) return true;
  return static_cast<__int128>(a.offset) * b.length <= static_cast<__int128>(b.offset) * a.length;
}

/// Goes on to the voxel behind the next crossing of an axis, if `goes`.
GVOM_HD inline void step_if(bool goes, RayAxis& axis) {
  axis.voxel += goes ? axis.step : 0;
  axis.offset += goes ? kFixedOne : 0;
  axis.crossings -= goes ? 1 : 0;
}

/// Calls `visit(x, y, z)` for every voxel that the segment goes through, first to last, except the
/// voxel of its end, until that says false; after each step `step(axis, x, y, z)` with the voxel that it led
/// to. `from` and `to` are fixed coordinates.
template <class Visit, class Step>
GVOM_HD void walk_ray(const std::int64_t (&from)[3], const std::int64_t (&to)[3], Visit&& visit,
                      Step&& step) {
  RayAxis x = ray_axis(from[0], to[0]), y = ray_axis(from[1], to[1]), z = ray_axis(from[2], to[2]);
  for (std::int64_t left = std::int64_t{x.crossings} + y.crossings + z.crossings; left > 0; --left) {
    if (!visit(x.voxel, y.voxel, z.voxel)) return;
    const bool x_first = crosses_first(x, y);
    const bool z_last = x_first ? crosses_first(x, z) : crosses_first(y, z);
    step_if(x_first && z_last, x);
    step_if(!x_first && z_last, y);
    step_if(!z_last, z);
    step(z_last ? (x_first ? 0 : 1) : 2, x.voxel, y.voxel, z.voxel);
  }
}
template <class Visit>
GVOM_HD void walk_ray(const std::int64_t (&from)[3], const std::int64_t (&to)[3], Visit&& visit) {
  walk_ray(from, to, visit, [](int, std::int32_t, std::int32_t, std::int32_t) {});
}

}  // namespace gvom
