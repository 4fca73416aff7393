#pragma once

#include <cuda_runtime.h>

#include <cstdint>

namespace gvom::cuda {

/// For each element of an array: gives it a value.
template <class T>
struct Fill {
  T* to;
  T value;
  __device__ void operator()(std::int32_t i) const { to[i] = value; }
};

}  // namespace gvom::cuda
