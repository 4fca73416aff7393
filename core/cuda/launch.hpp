// The one way in which kernels are started: a functor is called for every index of a range, by a thread for
// each or by a warp for each (core/cuda/lanes.hpp).
//
// Functors are structs of plain values and device pointers with `__device__ void operator()(std::int32_t i)
// const`. The tests compile all of this for a CUDA runtime of their own, which runs kernels on the host
// (tests/fake_cuda).
#pragma once

#include <cuda_runtime.h>

#include <cstdint>
#include <typeinfo>

#include "core/cuda/device.hpp"
#include "core/cuda/lanes.hpp"

namespace gvom::cuda {

namespace detail {

inline constexpr unsigned kBlock = 256;

__device__ inline std::int32_t this_thread() {
  return static_cast<std::int32_t>(blockIdx.x * kBlock + threadIdx.x);
}
__device__ inline std::int32_t all_threads() {
  return static_cast<std::int32_t>(gridDim.x * kBlock);
}

template <class Functor>
__global__ void __launch_bounds__(kBlock) each(std::int32_t n, const Functor functor) {
  if (this_thread() < n) functor(this_thread());
}

template <class Functor>
__global__ void __launch_bounds__(kBlock) each_warp(std::int32_t n, const Functor functor) {
  if (calls_for_warp() && this_thread() / kLanes < n) functor(this_thread() / kLanes);
}

// Three blocks of a multiprocessor: without being told, the compiler spills registers to fit a fourth.
template <class Functor>
__global__ void __launch_bounds__(kBlock, 3)
    each_warp_counted(const std::uint32_t* count, std::int32_t per_item, const Functor functor) {
  const auto n = static_cast<std::int32_t>(*count) * per_item;
  if (!calls_for_warp()) return;
  for (std::int32_t i = this_thread() / kLanes; i < n; i += all_threads() / kLanes) functor(i);
}

template <class Functor, class... Wanted, class... Given>
void start(Device& device, std::int64_t threads, void (*kernel)(Wanted...), const Given&... given) {
  if (threads <= 0 || device.failed()) return;
  cudaLaunchConfig_t config{};
  config.gridDim = dim3(static_cast<unsigned>((threads + kBlock - 1) / kBlock));
  config.blockDim = dim3(kBlock);
  config.stream = static_cast<cudaStream_t>(device.stream());
  device.begin_kernel(typeid(Functor).name());
  device.note_launch(cudaLaunchKernelEx(&config, kernel, given...));
}

}  // namespace detail

/// Calls `functor(i)` for i in 0 .. n - 1, in any order and at the same time.
template <class Functor>
void for_each(Device& device, std::int32_t n, const Functor& functor) {
  detail::start<Functor>(device, n, detail::each<Functor>, n, functor);
}

/// The same, each call by all lanes of a warp.
template <class Functor>
void for_each_warp(Device& device, std::int32_t n, const Functor& functor) {
  detail::start<Functor>(device, std::int64_t{n} * kLanes, detail::each_warp<Functor>, n, functor);
}

/// The same for i in 0 .. *count * per_item - 1, where `count` lies in the device's memory and is read when
/// the work begins.
template <class Functor>
void for_each_warp_counted(Device& device, const std::uint32_t* count, std::int32_t per_item,
                           const Functor& functor) {
  const std::int64_t blocks = std::int64_t{device.info().multiprocessors} * 8;  // as many as fit at a time
  detail::start<Functor>(device, blocks * detail::kBlock, detail::each_warp_counted<Functor>, count, per_item,
                         functor);
}

}  // namespace gvom::cuda
