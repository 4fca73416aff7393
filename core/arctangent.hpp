// An arctangent of basic operations only, so that CPU and GPU agree to the byte (their libraries' do not).
#pragma once

#include "core/format/platform.hpp"

namespace gvom {

/// atan(k / 8) for k in 0 .. 8.
#define GVOM_ARCTANGENTS                                                                    \
  {                                                                                         \
    0.0, 0.12435499454676144, 0.24497866312686414, 0.35877067027057225, 0.4636476090008061, \
        0.5585993153435624, 0.6435011087932844, 0.7188299996216245, 0.7853981633974483      \
  }
inline constexpr double kArctangents[9] = GVOM_ARCTANGENTS;
#ifdef __CUDACC__
// A table that a GPU looks up by index lies in its constant memory, or else in slow memory of each thread.
[[maybe_unused]] static __device__ __constant__ const double kArctangentsOnDevice[9] = GVOM_ARCTANGENTS;
#endif
#undef GVOM_ARCTANGENTS

GVOM_HD inline double tabled_arctangent(int eighths) {
#ifdef __CUDA_ARCH__
  return kArctangentsOnDevice[eighths];
#else
  return kArctangents[eighths];
#endif
}

/// Arctangent of `x >= 0` in radians, to about 1e-16. From the nearest of nine table points `c` by
/// atan(x) = atan(c) + atan((x - c) / (1 + x c)), whose last term is at most atan(1/16): a short series.
GVOM_HD inline double arctangent(double x) {
  constexpr double kHalfPi = 1.5707963267948966;
  const bool steep = x > 1;
  const double y = steep ? 1 / x : x;
  const int k = static_cast<int>(y * 8 + 0.5);
  const double c = k * 0.125;
  const double t = (y - c) / (1 + y * c);
  const double t2 = t * t;
  double series = 1.0 / 13;
  series = 1.0 / 11 - t2 * series;
  series = 1.0 / 9 - t2 * series;
  series = 1.0 / 7 - t2 * series;
  series = 1.0 / 5 - t2 * series;
  series = 1.0 / 3 - t2 * series;
  series = 1.0 - t2 * series;
  const double angle = tabled_arctangent(k) + t * series;
  return steep ? kHalfPi - angle : angle;
}

}  // namespace gvom
