// As much of the CUDA runtime's interface as core/cuda uses, for a device that is the host (tests/fake_cuda).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <tuple>
#include <typeinfo>
#include <utility>

#define __global__
#define __device__
#define __host__
#define __constant__
#define __launch_bounds__(...)

struct dim3 {
  unsigned x = 1, y = 1, z = 1;
  constexpr dim3(unsigned along_x = 1, unsigned along_y = 1, unsigned along_z = 1)
      : x(along_x), y(along_y), z(along_z) {}
};
/// Where the kernel's thread that runs now is.
inline thread_local dim3 threadIdx, blockIdx, blockDim, gridDim;

enum cudaError_t {
  cudaSuccess = 0,
  cudaErrorInvalidValue = 1,
  cudaErrorMemoryAllocation = 2,
  cudaErrorInsufficientDriver = 35,
  cudaErrorNoDevice = 100,
  cudaErrorInvalidResourceHandle = 400,
  cudaErrorIllegalState = 401,
  cudaErrorNotReady = 600,
  cudaErrorIllegalAddress = 700,
  cudaErrorLaunchOutOfResources = 701,
  cudaErrorHostMemoryAlreadyRegistered = 712,
  cudaErrorNotSupported = 801,
  cudaErrorStreamCaptureUnsupported = 900,
  cudaErrorStreamCaptureInvalidated = 901,
};
enum cudaMemcpyKind { cudaMemcpyHostToDevice = 1, cudaMemcpyDeviceToHost = 2, cudaMemcpyDeviceToDevice = 3 };
enum cudaMemoryType { cudaMemoryTypeUnregistered = 0, cudaMemoryTypeHost = 1, cudaMemoryTypeDevice = 2 };
enum cudaStreamCaptureMode { cudaStreamCaptureModeThreadLocal = 1 };
inline constexpr unsigned cudaStreamDefault = 0, cudaStreamNonBlocking = 1;
inline constexpr unsigned cudaHostRegisterPortable = 1, cudaHostRegisterMapped = 2;

struct FakeStream;
struct FakeEvent;
struct FakeGraph;
struct FakePlayable;
using cudaStream_t = FakeStream*;
using cudaEvent_t = FakeEvent*;
using cudaGraph_t = FakeGraph*;
using cudaGraphExec_t = FakePlayable*;

struct cudaDeviceProp {
  char name[256];
  int major, minor, multiProcessorCount, integrated;
};
struct cudaPointerAttributes {
  cudaMemoryType type;
};
struct cudaLaunchConfig_t {
  dim3 gridDim, blockDim;
  std::size_t dynamicSmemBytes;
  cudaStream_t stream;
};

cudaError_t cudaGetDeviceCount(int* count);
cudaError_t cudaSetDevice(int device);
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device);
cudaError_t cudaDriverGetVersion(int* version);
cudaError_t cudaRuntimeGetVersion(int* version);
cudaError_t cudaGetLastError();
const char* cudaGetErrorString(cudaError_t error);

cudaError_t cudaMalloc(void** memory, std::size_t bytes);
cudaError_t cudaFree(void* memory);
cudaError_t cudaMallocHost(void** memory, std::size_t bytes);
cudaError_t cudaFreeHost(void* memory);
cudaError_t cudaHostRegister(void* memory, std::size_t bytes, unsigned flags);
cudaError_t cudaHostUnregister(void* memory);
cudaError_t cudaHostGetDevicePointer(void** device, void* host, unsigned flags);
cudaError_t cudaPointerGetAttributes(cudaPointerAttributes* attributes, const void* memory);

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags);
cudaError_t cudaStreamDestroy(cudaStream_t stream);
cudaError_t cudaStreamSynchronize(cudaStream_t stream);
cudaError_t cudaEventCreate(cudaEvent_t* event);
cudaError_t cudaEventDestroy(cudaEvent_t event);
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream);
cudaError_t cudaEventElapsedTime(float* ms, cudaEvent_t from, cudaEvent_t to);
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                            cudaStream_t stream);
cudaError_t cudaMemsetAsync(void* begin, int value, std::size_t bytes, cudaStream_t stream);

cudaError_t cudaStreamBeginCapture(cudaStream_t stream, cudaStreamCaptureMode mode);
cudaError_t cudaStreamEndCapture(cudaStream_t stream, cudaGraph_t* graph);
cudaError_t cudaGraphInstantiate(cudaGraphExec_t* playable, cudaGraph_t graph, unsigned long long flags);
cudaError_t cudaGraphUpload(cudaGraphExec_t playable, cudaStream_t stream);
cudaError_t cudaGraphLaunch(cudaGraphExec_t playable, cudaStream_t stream);
cudaError_t cudaGraphDestroy(cudaGraph_t graph);
cudaError_t cudaGraphExecDestroy(cudaGraphExec_t playable);

namespace fake_cuda {
/// `threads` does what the kernel's threads `begin` .. `end` - 1 of all blocks do, one after the other; `type` has the
/// kernel's functor in it, as typeid tells it.
cudaError_t launch(const cudaLaunchConfig_t& config, const char* type,
                   std::function<void(std::uint64_t begin, std::uint64_t end)> threads);
}  // namespace fake_cuda

template <class... Wanted, class... Given>
cudaError_t cudaLaunchKernelEx(const cudaLaunchConfig_t* config, void (*kernel)(Wanted...),
                               Given&&... given) {
  using Values = std::tuple<Wanted...>;
  const unsigned block = config->blockDim.x;
  return fake_cuda::launch(*config, typeid(Values).name(),
                           [kernel, block, values = Values(std::forward<Given>(given)...)](std::uint64_t begin,
                                                                                           std::uint64_t end) {
                             for (std::uint64_t i = begin; i < end; ++i) {
                               blockIdx.x = static_cast<unsigned>(i / block);
                               threadIdx.x = static_cast<unsigned>(i % block);
                               std::apply(kernel, values);
                             }
                           });
}

// Lanes of a warp run one after the other: each is alone when it asks for company.
inline unsigned __activemask() {
  return 1U << (threadIdx.x % 32);
}
inline unsigned __match_any_sync(unsigned mask, unsigned long long /*value*/) {
  return mask;
}
inline int __ffs(int bits) {
  return __builtin_ffs(bits);
}
inline int __popcll(unsigned long long bits) {
  return __builtin_popcountll(bits);
}
inline int __popc(unsigned bits) {
  return __builtin_popcount(bits);
}

// Atomic for real: several threads of the host may run a kernel's.
inline unsigned atomicAdd(unsigned* place, unsigned value) {
  return __atomic_fetch_add(place, value, __ATOMIC_RELAXED);
}
template <class T>
T fake_atomic_choice(T* place, T value, bool (*better)(T, T)) {
  T now = __atomic_load_n(place, __ATOMIC_RELAXED);
  while (better(value, now) &&
         !__atomic_compare_exchange_n(place, &now, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
  return now;
}
inline int atomicMin(int* place, int value) {
  return fake_atomic_choice<int>(place, value, [](int a, int b) { return a < b; });
}
inline unsigned atomicMax(unsigned* place, unsigned value) {
  return fake_atomic_choice<unsigned>(place, value, [](unsigned a, unsigned b) { return a > b; });
}
inline int __float_as_int(float value) {
  int bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}
inline unsigned __float_as_uint(float value) {
  return static_cast<unsigned>(__float_as_int(value));
}
