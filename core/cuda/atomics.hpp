// Updates of memory that several threads of a kernel may touch at once. Sums of integers and minima: their
// order does not show.
#pragma once

#include <cuda_runtime.h>

#include <cstdint>

namespace gvom::cuda {

/// Adds one. Threads of a warp that meet at one counter add together: near the sensor all rays do.
__device__ inline void add_one(std::uint32_t* counter) {
  const unsigned meet = __match_any_sync(__activemask(), reinterpret_cast<unsigned long long>(counter));
  const int first = __ffs(static_cast<int>(meet)) - 1;
  if (static_cast<int>(threadIdx.x & 31) == first) atomicAdd(counter, static_cast<unsigned>(__popc(meet)));
}

/// Takes `count` places and returns the first: every caller gets others.
__device__ inline std::uint32_t take(std::uint32_t* next, std::uint32_t count) {
  return atomicAdd(next, count);
}

/// Lowers a height to `value`. Neither is NaN or -0, so floats of one sign are in the order of their bits.
__device__ inline void lower_to(float* height_m, float value_m) {
  if (value_m >= 0)
    atomicMin(reinterpret_cast<int*>(height_m), __float_as_int(value_m));
  else
    atomicMax(reinterpret_cast<unsigned*>(height_m), __float_as_uint(value_m));
}

/// Lowers a number to `value`. Most rays find it as low already.
__device__ inline void lower_to(std::int32_t* number, std::int32_t value) {
#ifdef __CUDACC__
  const std::int32_t found = *static_cast<const volatile std::int32_t*>(number);
#else
  const std::int32_t found = __atomic_load_n(number, __ATOMIC_RELAXED);
#endif
  if (value < found) atomicMin(number, value);
}

/// Sets a byte that other threads may set to the same.
__device__ inline void mark(std::uint8_t* byte) {
#ifdef __CUDACC__
  *byte = 1;
#else
  __atomic_store_n(byte, std::uint8_t{1}, __ATOMIC_RELAXED);
#endif
}

}  // namespace gvom::cuda
