// Updates of memory that several threads of a kernel may touch at once. Sums of integers and minima: their
// order does not show.
#pragma once

#include <cstdint>

#include "core/cell.hpp"

namespace gvom::cuda {

/// Adds one. Threads of a warp that meet at one counter add together: near the sensor all rays do.
GVOM_HD inline void add_one(std::uint32_t* counter) {
#ifdef __CUDA_ARCH__
  const unsigned meet = __match_any_sync(__activemask(), reinterpret_cast<unsigned long long>(counter));
  const int first = __ffs(static_cast<int>(meet)) - 1;
  if (static_cast<int>(threadIdx.x & 31) == first) atomicAdd(counter, static_cast<unsigned>(__popc(meet)));
#else
  ++*counter;
#endif
}

/// Takes the counter's value and adds one: every caller gets another value.
GVOM_HD inline std::uint32_t take_one(std::uint32_t* counter) {
#ifdef __CUDA_ARCH__
  return atomicAdd(counter, 1u);
#else
  return (*counter)++;
#endif
}

/// Lowers a height to `value`. Neither is NaN or -0, so floats of one sign are in the order of their bits.
GVOM_HD inline void lower_to(float* height_m, float value_m) {
#ifdef __CUDA_ARCH__
  if (value_m >= 0)
    atomicMin(reinterpret_cast<int*>(height_m), __float_as_int(value_m));
  else
    atomicMax(reinterpret_cast<unsigned*>(height_m), __float_as_uint(value_m));
#else
  *height_m = lower(*height_m, value_m);
#endif
}

}  // namespace gvom::cuda
