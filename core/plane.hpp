// The plane through a column's neighbourhood (R12), for host and device.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/arctangent.hpp"
#include "core/format/layers.hpp"
#include "core/format/platform.hpp"

namespace gvom {

struct Plane {
  float slope_x;    ///< m/m
  float slope_y;    ///< m/m
  float slope;      ///< rad
  float roughness;  ///< m^2
  bool steep;       ///< `slope >= threshold`
};

/// Sums over the defined heights around a column. Those of offsets are whole numbers of columns, so
/// whether the points lie on one line is decided exactly.
struct PlaneSums {
  std::int32_t n, x, y, xx, xy, yy;
  double z, xz, yz;
};

/// Adds the height `z_m` of the column (dx, dy) further on; an undefined one adds nothing.
GVOM_HD inline void add_height(PlaneSums& s, std::int32_t dx, std::int32_t dy, float z_m) {
  const double wide = static_cast<double>(z_m);
  const std::int32_t one = wide == wide ? 1 : 0;
  const double z = wide == wide ? wide : 0;
  s.n += one, s.x += one * dx, s.y += one * dy;
  s.xx += one * dx * dx, s.xy += one * dx * dy, s.yy += one * dy * dy;
  s.z += z, s.xz += dx * z, s.yz += dy * z;
}

/// `z = a x + b y + c` with x and y in columns; undefined without enough points that span a plane.
struct PlaneFit {
  double a, b, c;
  bool defined;
};

/// Fewer columns with ground do not say how it slopes.
inline constexpr std::int32_t kLeastPlaneColumns = 5;

/// Least squares (R12).
GVOM_HD inline PlaneFit solve_plane(const PlaneSums& s) {
  const double n = s.n, x = s.x, y = s.y;
  const double cxx = n * s.xx - x * x, cxy = n * s.xy - x * y, cyy = n * s.yy - y * y;
  const double determinant = cxx * cyy - cxy * cxy;  // whole numbers below 2^53: exact
  const double cxz = n * s.xz - x * s.z;
  const double cyz = n * s.yz - y * s.z;
  const double a = (cyy * cxz - cxy * cyz) / determinant;
  const double b = (cxx * cyz - cxy * cxz) / determinant;
  const bool defined = (static_cast<int>(s.n >= kLeastPlaneColumns) & static_cast<int>(determinant > 0)) != 0;
  return {a, b, ((s.z - a * x) - b * y) / n, defined};
}

/// Squared vertical distance of a height from the plane; 0 of an undefined one.
GVOM_HD inline double squared_residual(const PlaneFit& fit, std::int32_t dx, std::int32_t dy, float z_m) {
  const double residual = static_cast<double>(z_m) - ((fit.a * dx + fit.b * dy) + fit.c);
  const double square = residual * residual;
  return z_m == z_m ? square : 0;
}

/// How far columns spread about their mean along the axis along which they spread less: a sum of squares,
/// columns^2.
GVOM_HD inline double least_spread(const PlaneSums& s) {
  const double n = s.n, x = s.x, y = s.y;
  const double cxx = n * s.xx - x * x, cyy = n * s.yy - y * y;
  return (cxx < cyy ? cxx : cyy) / n;
}

/// What ground a column gives to a plane: bits of a byte.
enum Source : std::uint8_t { kNoGround = 0, kGroundNow = 1, kGroundRemembered = 2 };

/// Of a column with ground, by its layer `visibility`.
GVOM_HD inline Source source_of_ground(std::uint8_t visibility) {
  return is_remembered(visibility) ? kGroundRemembered : kGroundNow;
}

/// Of ground of two times (R17) a plane may lean by so much without leaning, m/m: the odometry has drifted.
inline constexpr double kSeamSlope = 0.25;

/// Whether some of a plane's columns have ground of now, and some ground that is remembered.
/// @param source(dx, dy) of `Source`
template <class SourceOf>
GVOM_HD bool is_seam(std::int32_t radius, SourceOf&& source) {
  unsigned sources = kNoGround;
  for (std::int32_t dy = -radius; dy <= radius; ++dy)
    for (std::int32_t dx = -radius; dx <= radius; ++dx) sources |= source(dx, dy);
  return sources == (kGroundNow | kGroundRemembered);
}

/// The layers of a fitted plane (R12). It is steep if its slope is, and that slope less its standard error:
/// uneven ground is rough, not steep. @param is_seam() whether its ground is of two times
template <class IsSeam>
GVOM_HD Plane plane_layers(const PlaneFit& fit, const PlaneSums& sums, double squares_m2, double resolution_m,
                           double threshold_rad, IsSeam&& is_seam) {
  if (!fit.defined) return {kUnknown, kUnknown, kUnknown, kUnknown, false};
  const double slope_x = fit.a / resolution_m, slope_y = fit.b / resolution_m;
  const double slope = std::sqrt(slope_x * slope_x + slope_y * slope_y);
  const double roughness = squares_m2 / sums.n;
  const double slope_rad = arctangent(slope);
  const auto steep = [&] {
    const double least = slope - std::sqrt(roughness / least_spread(sums)) / resolution_m;
    if (!(least > 0 && arctangent(least) >= threshold_rad)) return false;
    const double over_seam = least - kSeamSlope;
    return (over_seam > 0 && arctangent(over_seam) >= threshold_rad) || !is_seam();
  };
  return {static_cast<float>(slope_x), static_cast<float>(slope_y), static_cast<float>(slope_rad),
          static_cast<float>(roughness), slope_rad >= threshold_rad && steep()};
}

}  // namespace gvom
