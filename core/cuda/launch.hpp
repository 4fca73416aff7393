// The one way in which kernels are started: a functor is called for every index of a range.
//
// Functors are structs of plain values and device pointers with `GVOM_HD void operator()(std::int32_t i)
// const`. nvcc makes kernels of them; any other compiler makes loops, which the serial device of the tests
// runs on the host, in order.
#pragma once

#include <cstdint>

#include "core/cuda/device.hpp"
#include "core/format/platform.hpp"

#ifdef __CUDACC__
#include <cuda_runtime.h>
#endif

namespace gvom::cuda {

#ifdef __CUDACC__

namespace detail {

inline constexpr unsigned kBlock = 256;

template <class Functor>
__global__ void __launch_bounds__(kBlock) each(std::int32_t n, const Functor functor) {
  const auto i = static_cast<std::int32_t>(blockIdx.x * kBlock + threadIdx.x);
  if (i < n) functor(i);
}

template <class Functor>
__global__ void __launch_bounds__(kBlock)
    each_counted(const std::uint32_t* count, std::int32_t per_item, const Functor functor) {
  const auto n = static_cast<std::int32_t>(*count) * per_item;
  const auto stride = static_cast<std::int32_t>(gridDim.x * kBlock);
  for (auto i = static_cast<std::int32_t>(blockIdx.x * kBlock + threadIdx.x); i < n; i += stride) functor(i);
}

}  // namespace detail

/// Calls `functor(i)` for i in 0 .. n - 1, in any order and at the same time.
template <class Functor>
void for_each(Device& device, std::int32_t n, const Functor& functor) {
  if (n <= 0 || device.failed()) return;
  const unsigned blocks = (static_cast<unsigned>(n) + detail::kBlock - 1) / detail::kBlock;
  detail::each<<<blocks, detail::kBlock, 0, static_cast<cudaStream_t>(device.stream())>>>(n, functor);
  device.note_launch(cudaGetLastError());
}

/// The same for i in 0 .. *count * per_item - 1, where `count` lies in the device's memory and is read when
/// the work begins.
template <class Functor>
void for_each_counted(Device& device, const std::uint32_t* count, std::int32_t per_item,
                      const Functor& functor) {
  if (device.failed()) return;
  const auto blocks = static_cast<unsigned>(device.info().multiprocessors) * 8;  // as many as fit at a time
  detail::each_counted<<<blocks, detail::kBlock, 0, static_cast<cudaStream_t>(device.stream())>>>(
      count, per_item, functor);
  device.note_launch(cudaGetLastError());
}

#else

template <class Functor>
void for_each(Device& device, std::int32_t n, const Functor& functor) {
  if (n <= 0) return;
  device.run_serially([n, functor] {
    for (std::int32_t i = 0; i < n; ++i) functor(i);
  });
}

template <class Functor>
void for_each_counted(Device& device, const std::uint32_t* count, std::int32_t per_item,
                      const Functor& functor) {
  device.run_serially([count, per_item, functor] {
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(*count) * per_item; ++i) functor(i);
  });
}

#endif

}  // namespace gvom::cuda
