// CUB's running sum, for the host.
#pragma once

#include <cuda_runtime.h>

#include <numeric>

namespace cub {

struct DeviceScan {
  template <class T>
  static cudaError_t ExclusiveSum(void* scratch, std::size_t& scratch_bytes, const T* values, T* sums,
                                  std::size_t count, cudaStream_t stream = nullptr) {
    if (scratch == nullptr) {
      scratch_bytes = 1;
      return cudaSuccess;
    }
    cudaLaunchConfig_t one{};
    one.stream = stream;
    return fake_cuda::launch(one, "running sum", [=](std::uint64_t, std::uint64_t) { std::exclusive_scan(values, values + count, sums, T{0}); });
  }
};

}  // namespace cub
