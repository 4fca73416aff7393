// Marks functions that a GPU back end compiles for the device too.
#pragma once

#include <limits>

#ifdef __CUDACC__
#define GVOM_HD __host__ __device__
#else
#define GVOM_HD
#endif

/// Before a short loop whose arrays are to stay in a GPU's registers.
#ifdef __CUDA_ARCH__
#define GVOM_UNROLL _Pragma("unroll")
#else
#define GVOM_UNROLL
#endif

namespace gvom {

/// An unknown value of a layer. A constant of the compiler, 0x7fc00000: what a processor makes of 0 / 0
/// differs between a CPU and a GPU.
inline constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

}  // namespace gvom
