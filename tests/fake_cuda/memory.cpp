// Memory of the device, which is the host's; and of the host, pinned or not. What nobody has written yet is
// poison.
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "tests/fake_cuda/state.hpp"

using namespace fake_cuda;

namespace {

constexpr std::size_t kAlignment = 256;
constexpr int kPoison = 0xA5;

cudaError_t take(void** memory, std::size_t bytes, Ranges& ranges) {
  *memory = std::aligned_alloc(kAlignment, (bytes + kAlignment - 1) / kAlignment * kAlignment);
  std::memset(*memory, kPoison, bytes);
  ranges[static_cast<std::byte*>(*memory)] = bytes;
  ++state().counts.allocations;
  return cudaSuccess;
}

void release(const char* call, void* memory, Ranges& ranges) {
  for (FakeStream* stream : state().streams) run(stream);  // as the real one, it waits
  if (ranges.erase(static_cast<std::byte*>(memory)) == 0) finding(call, "not memory of this kind");
  std::free(memory);
}

void check_ranges(const char* call, const void* to, const void* from, std::size_t bytes,
                  cudaMemcpyKind kind) {
  const Ranges& device = state().device_memory;
  const void* const host = kind == cudaMemcpyHostToDevice   ? from
                           : kind == cudaMemcpyDeviceToHost ? to
                                                            : nullptr;
  if (kind != cudaMemcpyDeviceToHost && !within(device, to, bytes))
    finding(call, "writes beyond device memory");
  if (kind != cudaMemcpyHostToDevice && !within(device, from, bytes))
    finding(call, "reads beyond device memory");
  if (host == nullptr) return;
  if (within(device, host, 1)) finding(call, "device memory as the host's");
  if (locked(host, 1) != locked(host, bytes)) finding(call, "memory that is pinned in part");
}

}  // namespace

cudaError_t cudaMalloc(void** memory, std::size_t bytes) {
  FAKE_CUDA_ENTER(InCapture::breaks);
  return take(memory, bytes, state().device_memory);
}

cudaError_t cudaMallocHost(void** memory, std::size_t bytes) {
  FAKE_CUDA_ENTER(InCapture::breaks);
  return take(memory, bytes, state().pinned);
}

cudaError_t cudaFree(void* memory) {
  release(__func__, memory, state().device_memory);
  return enter(__func__, InCapture::breaks);
}

cudaError_t cudaFreeHost(void* memory) {
  release(__func__, memory, state().pinned);
  return enter(__func__, InCapture::breaks);
}

cudaError_t cudaHostRegister(void* memory, std::size_t bytes, unsigned /*flags*/) {
  FAKE_CUDA_ENTER(InCapture::breaks);
  if (state().refuses_to_pin) return give(cudaErrorNotSupported);
  const auto* begin = static_cast<std::byte*>(memory);
  for (const auto& [other, other_bytes] : state().registered)
    if (begin < other + other_bytes && other < begin + bytes)
      return give(cudaErrorHostMemoryAlreadyRegistered);
  state().registered[begin] = bytes;
  return cudaSuccess;
}

cudaError_t cudaHostUnregister(void* memory) {
  if (state().registered.erase(static_cast<std::byte*>(memory)) == 0) finding(__func__, "not registered");
  return enter(__func__, InCapture::breaks);
}

cudaError_t cudaHostGetDevicePointer(void** device, void* host, unsigned /*flags*/) {
  FAKE_CUDA_ENTER(InCapture::allowed);
  if (!locked(host, 1)) return give(cudaErrorInvalidValue);
  *device = host;
  return cudaSuccess;
}

cudaError_t cudaPointerGetAttributes(cudaPointerAttributes* attributes, const void* memory) {
  FAKE_CUDA_ENTER(InCapture::allowed);
  attributes->type = locked(memory, 1)                          ? cudaMemoryTypeHost
                     : within(state().device_memory, memory, 1) ? cudaMemoryTypeDevice
                                                                : cudaMemoryTypeUnregistered;
  return cudaSuccess;
}

cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                            cudaStream_t stream) {
  FAKE_CUDA_ENTER(InCapture::allowed);
  require_stream(__func__, stream);
  check_ranges(__func__, to, from, bytes, kind);
  const void* const host = kind == cudaMemcpyDeviceToHost ? to : from;
  if (kind == cudaMemcpyDeviceToDevice || locked(host, bytes)) {
    enqueue(stream, [=] { std::memcpy(to, from, bytes); });
    return cudaSuccess;
  }
  if (stream->capture != nullptr) {
    stream->capture_broken = true;
    return give(cudaErrorStreamCaptureUnsupported);
  }
  if (kind == cudaMemcpyDeviceToHost) {
    enqueue(stream, [=] { std::memcpy(to, from, bytes); });
    run(stream);
    return cudaSuccess;
  }
  ++state().counts.pageable_uploads;
  const auto* begin = static_cast<const std::byte*>(from);
  const auto staged = std::make_shared<std::vector<std::byte>>(begin, begin + bytes);
  enqueue(stream, [=] { std::memcpy(to, staged->data(), bytes); });
  return cudaSuccess;
}

cudaError_t cudaMemsetAsync(void* begin, int value, std::size_t bytes, cudaStream_t stream) {
  FAKE_CUDA_ENTER(InCapture::allowed);
  require_stream(__func__, stream);
  if (!within(state().device_memory, begin, bytes)) finding(__func__, "writes beyond device memory");
  enqueue(stream, [=] { std::memset(begin, value, bytes); });
  return cudaSuccess;
}
